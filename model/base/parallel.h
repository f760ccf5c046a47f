// Work shared among threads by index, so that a result never depends on how many threads there were.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace ctu {

/// Threads this machine offers; never 0.
inline int available_threads() {
  const unsigned n = std::thread::hardware_concurrency();
  return n == 0 ? 1 : static_cast<int>(n);
}

/// Calls `body(first, last)` for consecutive chunks of [0, count); chunks run on up to `threads`
/// threads in any order. The first exception of a chunk is rethrown here.
template <class Body>
void parallel_chunks(std::size_t count, std::size_t chunk, int threads, Body&& body) {
  const std::size_t chunks = count == 0 ? 0 : (count + chunk - 1) / chunk;
  if (threads <= 1 || chunks <= 1) {
    for (std::size_t c = 0; c < chunks; ++c) body(c * chunk, c * chunk + chunk < count ? c * chunk + chunk : count);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  auto worker = [&] {
    for (std::size_t c = next++; c < chunks; c = next++) {
      try {
        body(c * chunk, c * chunk + chunk < count ? c * chunk + chunk : count);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
        next = chunks;
      }
    }
  };
  std::vector<std::thread> pool;
  const std::size_t workers = chunks < static_cast<std::size_t>(threads) ? chunks : static_cast<std::size_t>(threads);
  pool.reserve(workers);
  try {
    for (std::size_t i = 1; i < workers; ++i) pool.emplace_back(worker);
  } catch (const std::exception&) {
    // No more threads are to be had: those there are do the work.
  }
  worker();
  for (auto& t : pool) t.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace ctu
