// Exit codes: 0 done, 1 a check failed, 2 bad usage, configuration or input, or nothing left of what a system gives
// (memory, disk), 3 deadlock or limit.
#include <cstdio>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/pipeline/engine.h"
#include "model/unit/run.h"
#include "sim/cli.h"

namespace {

constexpr int kBadInput = 2, kDeadlock = 3;

template <class... Args>
int refuse(int exit_code, fmt::format_string<Args...> format, Args&&... args) {
  fmt::print(stderr, format, std::forward<Args>(args)...);
  return exit_code;
}

/// What was printed may still lie in a buffer, and the disk behind it be full.
int flushed(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  return refuse(kBadInput, "ctusim: standard output cannot be written\n  remedy: check the space on the disk\n");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return flushed(ctu::sim::run_cli(argc, argv));
  } catch (const ctu::Error& e) {
    return refuse(kBadInput, "ctusim: {}\n", e.what());
  } catch (const ctu::unit::Deadlock& e) {
    return refuse(kDeadlock, "ctusim: deadlock\n{}\n", e.what());
  } catch (const ctu::pipeline::DeadlockFound& e) {  // of the unit in gates, alone or beside the model
    return refuse(kDeadlock, "ctusim: deadlock\n{}\n", e.what());
  } catch (const std::bad_alloc&) {
    return refuse(kBadInput,
                  "ctusim: out of memory\n  remedy: take a smaller scene, picture, R_ray or number of threads\n");
  } catch (const std::length_error&) {  // more than any memory holds
    return refuse(kBadInput, "ctusim: out of memory\n  remedy: take a smaller scene, picture or R_ray\n");
  } catch (const std::system_error& e) {  // of the file system, threads or standard output
    return refuse(kBadInput, "ctusim: {}\n  remedy: check names, permissions and the space on the disk\n", e.what());
  }
}
