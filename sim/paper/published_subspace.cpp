#include "sim/paper/published_subspace.h"

#include <algorithm>

namespace ctu::sim::paper {
namespace {

// Of each scene: Table 1 at R = 4 and 6, Table 2's seconds, Table 2 at R = 4 and 6, Table 3 at R = 4 and 6.
constexpr PublishedScene kScenes[] = {
    {"Bedroom",
     {{{89.3, 90.0, 89.8, 90.7}, {83.8, 84.9, 84.5, 86.9}}},
     73.89,
     {{{117.2, 103.6, 103.0}, {119.7, 106.5, 107.9}}},
     {{{216.6, 20.3}, {371.2, 46.8}}}},
    {"San Miguel",
     {{{79.3, 80.5, 80.2, 83.2}, {67.9, 70.6, 69.7, 76.5}}},
     180.03,
     {{{138.0, 97.6, 99.3}, {140.0, 98.2, 108.4}}},
     {{{4923.2, 446.6}, {9181.5, 983.7}}}},
    {"Ninja",
     {{{84.2, 85.5, 85.2, 90.0}, {76.5, 78.8, 78.0, 87.7}}},
     55.19,
     {{{113.7, 101.0, 101.2}, {118.1, 104.5, 110.3}}},
     {{{569.6, 63.1}, {1239.8, 139.1}}}},
    {"Bistro",
     {{{72.3, 73.8, 73.4, 78.2}, {59.1, 61.8, 61.0, 71.5}}},
     97.01,
     {{{124.8, 94.9, 97.1}, {127.1, 97.3, 105.7}}},
     {{{1295.2, 128.5}, {2646.1, 305.9}}}},
    {"Classroom",
     {{{87.4, 88.1, 87.9, 88.3}, {83.5, 83.3, 83.7, 85.1}}},
     123.31,
     {{{120.2, 106.0, 102.9}, {124.6, 107.1, 110.8}}},
     {{{279.7, 26.4}, {515.4, 60.9}}}},
    {"Hairball",
     {{{67.0, 71.5, 70.6, 73.2}, {54.4, 61.1, 58.8, 74.3}}},
     54.11,
     {{{132.1, 97.9, 98.0}, {132.5, 102.0, 110.9}}},
     {{{1396.5, 132.2}, {2039.0, 306.8}}}},
    {"Curly Hair",
     {{{57.5, 62.5, 61.5, 66.3}, {43.3, 50.6, 48.1, 60.4}}},
     82.74,
     {{{126.7, 86.9, 89.2}, {120.2, 87.1, 95.7}}},
     {{{5325.4, 543.0}, {8768.3, 1251.3}}}},
    {"Straight Hair",
     {{{56.5, 61.4, 60.3, 62.1}, {42.5, 49.3, 47.0, 53.6}}},
     54.34,
     {{{120.0, 88.0, 91.1}, {114.6, 85.6, 90.5}}},
     {{{3132.5, 326.7}, {4522.9, 777.2}}}},
    {"VictorianTrains",
     {{{85.1, 86.2, 85.9, 86.9}, {77.0, 78.7, 78.1, 81.1}}},
     129.19,
     {{{124.4, 104.3, 107.2}, {128.4, 110.0, 115.8}}},
     {{{409.8, 37.4}, {674.5, 95.0}}}},
};

struct Pair {
  const char* ours;
  Kinship kinship;
  const char* published;
  const char* remark;
};

constexpr Pair kPairs[] = {
    {"san-miguel", Kinship::Same, "San Miguel", "a part of the model: the building, 40,000 leaves, pots, tables"},
    {"classroom", Kinship::Like, "Classroom", "a classroom; not known to be the paper's"},
    {"straight-hair", Kinship::Like, "Straight Hair", "the same author's small model, as ribbons"},
    {"gen:straight-hair", Kinship::Like, "Straight Hair", "2,000 near-parallel strands by formula"},
    {"ratboy-mohawk", Kinship::Like, "Straight Hair", "2,228 guide hairs of very short segments"},
    {"gen:curly-hair", Kinship::Like, "Curly Hair", "2,000 helices by formula"},
    {"gen:hair-ball", Kinship::Like, "Hairball", "2,000 straight strands by formula"},
    {"bathroom", Kinship::Like, "Bedroom", "another interior"},
    {"kitchen", Kinship::Like, "Bedroom", "another interior"},
    {"breakfast", Kinship::Like, "Bedroom", "another interior, whose chairs have thin tilted legs"},
    {"sponza", Kinship::Like, "VictorianTrains", "another building from inside"},
};

}  // namespace

std::span<const PublishedScene> published_scenes() { return kScenes; }

const char* to_string(Kinship kinship) {
  return kinship == Kinship::Same ? "same" : kinship == Kinship::Like ? "like" : "none";
}

Counterpart counterpart(const std::string& name) {
  const std::string known = name.substr(0, name.find('?'));
  for (const Pair& pair : kPairs) {
    if (known != pair.ours) continue;
    const auto* scene = std::find_if(std::begin(kScenes), std::end(kScenes),
                                     [&](const PublishedScene& s) { return std::string(s.name) == pair.published; });
    return {pair.kinship, scene, pair.remark};
  }
  return {};
}

}  // namespace ctu::sim::paper
