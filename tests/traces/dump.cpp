// Records a small trace and writes what TraceReader finds in it as plain arrays, for the test of the documentation:
//   dump FOLDER   writes FOLDER/trace.ctut, rays.bin (8 binary32 a ray), hits.bin (t, u, v, primitive), and for each
//   stored design steps-NAME.bin (Step, 8 bytes) and first-NAME.bin (u64); and FOLDER/compressed.ctut, the same with
//   R = 5 and compressed masks, and FOLDER/stripped.ctut, that one with bare nodes; of all the object masks,
//   masks-NAME.bin (u64)
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "model/base/error.h"
#include "tests/traces/test_support.h"
#include "traces/mask_set.h"

namespace {

using namespace ctu;

template <class T>
void append(std::ofstream& file, const T& value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

void dump_masks(const std::string& folder, const std::string& name) {
  const traces::TraceReader reader(folder + "/" + name + ".ctut");
  const cull::ObjectMasks masks =
      traces::masks_of(reader.read_image(), reader.manifest().masks, reader.compression().get());
  std::ofstream file(folder + "/masks-" + name + ".bin", std::ios::binary);
  for (const std::uint64_t word : masks.bits) append(file, word);
}

void dump_compressed(const std::string& folder, const std::string& name, bool strip_full) {
  traces::RecordOptions options = traces::test::small_options();
  options.masks = {.resolution = 5, .ray_resolution = 5, .entries = 64};
  options.strip_full = strip_full;
  traces::record(traces::test::hair_scene(), options, folder + "/" + name + ".ctut");
}

void dump(const std::string& folder) {
  traces::record(traces::test::hair_scene(), traces::test::small_options(), folder + "/trace.ctut");
  const traces::TraceReader reader(folder + "/trace.ctut");
  std::ofstream rays(folder + "/rays.bin", std::ios::binary), hits(folder + "/hits.bin", std::ios::binary);
  for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
    const reference::RayBlock block = reader.read_block(b);
    for (const intersect::Ray& ray : block.rays) {
      append(rays, ray.origin), append(rays, ray.tmin);
      append(rays, ray.direction), append(rays, ray.tmax);
    }
    for (const intersect::Hit& hit : block.expected) append(hits, hit);
  }
  for (const traces::DesignCounts& design : reader.manifest().designs) {
    const std::string name(cull::to_string(design.design));
    std::ofstream steps(folder + "/steps-" + name + ".bin", std::ios::binary);
    std::ofstream first(folder + "/first-" + name + ".bin", std::ios::binary);
    std::uint64_t before = 0;
    append(first, before);
    for (std::uint64_t b = 0; b < reader.blocks(); ++b) {
      const reference::StepList list = reader.read_block(b, design.design).steps;
      for (const reference::Step& step : list.steps) append(steps, step);
      for (std::uint64_t ray = 1; ray <= list.rays(); ++ray) append(first, before + list.first_step[ray]);
      before += list.steps.size();
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    dump(argv[1]);
    dump_compressed(argv[1], "compressed", false);
    dump_compressed(argv[1], "stripped", true);
    dump_masks(argv[1], "trace");
    dump_masks(argv[1], "compressed");
    dump_masks(argv[1], "stripped");
  } catch (const ctu::Error& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 1;
  }
  return 0;
}
