// Who asks memory for lines, and how its requests are named behind the arbiter.
#pragma once

#include <cstdint>

#include "model/pipeline/slot_set.h"
#include "model/pipeline/tokens.h"

namespace ctu::pipeline {

enum class Client : std::uint8_t { NodeFetch, LeafFetch, Stack, TableFetch };
inline constexpr int kClients = 4;

/// Miss registers of the three fetches, and one refill for each context.
inline constexpr std::size_t kMaxOutstandingReads = 3 * 64 + kMaxContexts;

struct ClientRequest {
  Client client = Client::NodeFetch;
  MemoryRequest request;
};
struct ClientAnswer {
  Client client = Client::NodeFetch;
  std::uint16_t id = 0;
};

}  // namespace ctu::pipeline
