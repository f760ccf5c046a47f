#include "tests/fuzz/limits.h"

#include <csignal>
#include <cstdint>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace ctu::fuzz {
namespace {

constexpr int kFatal[] = {SIGALRM, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

// What the signal handler reads: written before an input runs, by the one thread there is.
struct {
  const std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  char file[512] = {};
  char message[1024] = {};
} watched;

void say(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(1);
}

extern "C" void save_and_leave(int signal) {
  const int to = open(watched.file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (to < 0 || write(to, watched.bytes, watched.size) < 0) say("the input could not be saved\n");
  say(signal == SIGALRM ? "an input takes too long\n" : "an input ends the process by a signal\n");
  say(watched.message);
  _exit(1);
}

/// A stack of its own for the handler: the other one may be what ran out.
void install_handlers() {
  static std::vector<char> stack(1u << 16);
  stack_t alternative{};
  alternative.ss_sp = stack.data();
  alternative.ss_size = stack.size();
  sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_handler = save_and_leave;
  action.sa_flags = SA_ONSTACK;
  for (const int signal : kFatal) sigaction(signal, &action, nullptr);
}

void copy_text(char* to, std::size_t room, const std::string& text) {
  const std::size_t bytes = text.size() < room ? text.size() : room - 1;
  std::memcpy(to, text.data(), bytes);
  to[bytes] = '\0';
}

}  // namespace

void limit_memory(std::size_t bytes) {
#if !defined(__SANITIZE_ADDRESS__)
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
#else
  static_cast<void>(bytes);
#endif
}

Watch::Watch(const Harness& harness, Input input, const std::string& file) {
  static const bool installed = (install_handlers(), true);
  static_cast<void>(installed);
  watched.bytes = input.data();
  watched.size = input.size();
  copy_text(watched.file, sizeof watched.file, file);
  copy_text(watched.message, sizeof watched.message,
            "replay it with: ctu_fuzz_replay " + std::string(harness.name) + " " + file + "\n");
  alarm(kMostSeconds);
}

Watch::~Watch() { alarm(0); }

}  // namespace ctu::fuzz
