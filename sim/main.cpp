// Exit codes: 0 done, 1 a check failed, 2 bad usage, configuration or input, 3 deadlock or limit.
#include <cstdio>
#include <new>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/pipeline/engine.h"
#include "model/unit/run.h"
#include "sim/cli.h"

int main(int argc, char** argv) {
  try {
    return ctu::sim::run_cli(argc, argv);
  } catch (const ctu::Error& e) {
    fmt::print(stderr, "ctusim: {}\n", e.what());
    return 2;
  } catch (const ctu::unit::Deadlock& e) {
    fmt::print(stderr, "ctusim: deadlock\n{}\n", e.what());
    return 3;
  } catch (const ctu::pipeline::DeadlockFound& e) {  // of the unit in gates, alone or beside the model
    fmt::print(stderr, "ctusim: deadlock\n{}\n", e.what());
    return 3;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "ctusim: out of memory\n  remedy: take a smaller scene, R_ray or number of threads\n");
    return 3;
  }
}
