#include "model/unit/pins.h"
#include "model/base/error.h"
namespace ctu::unit {
pipeline::UnitResult run_pins(const pipeline::UnitConfig&, const pipeline::Work&, const pipeline::EngineOptions&) {
  throw Error("--mode", "pins is not there yet", "choose another mode");
}
}
