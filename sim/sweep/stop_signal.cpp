#include "sim/sweep/stop_signal.h"

#include <signal.h>

namespace ctu::sweep {
namespace {

volatile sig_atomic_t caught = 0;

extern "C" void remember(int signal) { caught = signal; }

}  // namespace

StopSignal::StopSignal() {
  caught = 0;
  struct sigaction action {};
  action.sa_handler = remember;  // no SA_RESTART: a wait ends at once
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

StopSignal::~StopSignal() {
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
}

bool StopSignal::received() { return caught != 0; }
int StopSignal::exit_code() { return 128 + caught; }

}  // namespace ctu::sweep
