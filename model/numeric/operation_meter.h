// How many binary32 operations a computation by intervals or affine forms takes: what it would cost in gates or time.
#pragma once

#include <cstdint>

namespace ctu::numeric {

/// Operations on single binary32 numbers, each with one rounding; comparisons and signs are not counted.
struct OperationCounts {
  std::uint64_t additions = 0, multiplications = 0;
  std::uint64_t divisions = 0;  ///< square roots too

  std::uint64_t total() const { return additions + multiplications + divisions; }
  OperationCounts& operator+=(const OperationCounts& other) {
    additions += other.additions;
    multiplications += other.multiplications;
    divisions += other.divisions;
    return *this;
  }
};

/// Counts this thread's operations of interval.h and affine.h into `counts` while it lives; without one nothing is
/// counted. The innermost counts.
class OperationMeter {
 public:
  explicit OperationMeter(OperationCounts& counts) : outer_(current_) { current_ = &counts; }
  ~OperationMeter() { current_ = outer_; }
  OperationMeter(const OperationMeter&) = delete;
  OperationMeter& operator=(const OperationMeter&) = delete;

  static void add(unsigned additions, unsigned multiplications, unsigned divisions = 0) {
    if (current_ == nullptr) [[likely]]
      return;
    current_->additions += additions;
    current_->multiplications += multiplications;
    current_->divisions += divisions;
  }

 private:
  static inline thread_local OperationCounts* current_ = nullptr;
  OperationCounts* outer_;
};

}  // namespace ctu::numeric
