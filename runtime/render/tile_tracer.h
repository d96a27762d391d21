// One tile: rays to hits, hits to shading inputs, shading to colours. Used alike by the static pass
// and by every frame, which is why cached and full frames agree bit for bit. Owns its buffers; one
// a thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/render/camera_rays.h"
#include "runtime/render/filled_blocks.h"
#include "runtime/render/hit_runs.h"
#include "runtime/render/hit_sheet.h"
#include "runtime/render/occlusion.h"
#include "runtime/render/shading.h"
#include "runtime/render/top_scene.h"
#include "runtime/scene/color.h"

namespace probe::render {

// Nearest hits of a tile, compacted in sample order; after shade() with colours.
struct TileHits {
  int count = 0;
  // Lanes that missed are written behind the last hit, so there is room for one more.
  static constexpr std::size_t kRoom = kTileSamples + 1;
  std::array<std::uint8_t, kRoom> sample;
  std::array<std::uint32_t, kRoom> instance, part, primitive;
  std::array<const TriangleData*, kRoom> triangle;  // that of the three
  alignas(64) std::array<float, kRoom> t, u, v;

  // How many follow each other on one triangle of one instance, from hit `first` on: two things may
  // be of one mesh.
  std::size_t run(std::size_t first) const {
    std::size_t end = first + 1;
    while (end < static_cast<std::size_t>(count) && triangle[end] == triangle[first] &&
           instance[end] == instance[first])
      ++end;
    return end - first;
  }
  // Those from `first` to before `end`, to an earlier place.
  void move(std::size_t first, std::size_t end, std::size_t to) {
    const auto shift = [first, end, to](auto& array) {
      std::copy(array.data() + first, array.data() + end, array.data() + to);
    };
    shift(sample);
    shift(instance);
    shift(part);
    shift(primitive);
    shift(triangle);
    shift(t);
    shift(u);
    shift(v);
  }
};

// Hits kept for later, tile after tile.
struct StoredHits {
  struct Hit {
    std::uint8_t sample = 0;
    std::uint32_t instance = 0, part = 0, primitive = 0;
    float t = 0, u = 0, v = 0;
  };
  std::vector<Hit> hits;
  std::vector<std::uint32_t> first{0};  // per tile, and one behind the last

  void add_tile(const TileHits& tile);
};

class TileTracer {
 public:
  // Traces the blocks (b: samples 64 b .. 64 b + 63) against their instances, up to
  // `farthest[sample]`, then recomputes t, u and v of every hit in our own code, so that only the
  // choice of the triangle is Embree's. Blocks in `filled` and packets of which `known` knows all
  // samples are not traced; of packets in `hidden` nobody asks.
  void trace(const TopScene& scene, const RayOrigins& origins, const CameraRays& rays, int tile,
             const BlockSets& blocks, const float* farthest, const FilledBlocks& filled = {},
             const KnownTriangles& known = {}, PacketSet hidden = 0);
  // Leaves out the samples in `hidden`.
  void drop(const std::array<bool, kTileSamples>& hidden);
  // Takes hits of that tile and blocks which were traced before, leaving out samples in `hidden`.
  void take(const TopScene& scene, const StoredHits& stored, int tile, const BlockSets& blocks,
            const std::array<bool, kTileSamples>& hidden);
  // Attributes, textures and the shading law for all hits on `scene`.
  void shade(const TopScene& scene, const CameraRays& rays, int tile, const LightTable& lights,
             const Occlusion& occlusion);
  // Instead of shade(): the share of light that the dynamics leave each hit, 1 where none is
  // blocked: (A + sum of unblocked e NoL / pi) / (A + sum of e NoL / pi).
  void catch_shadow(const TopScene& scene, const CameraRays& rays, int tile,
                    const LightTable& lights, const TopScene& dynamics);

  const TileHits& hits() const { return hits_; }
  const ShadeOutput& colors() const { return output_; }
  const std::array<float, kTileSamples>& light_left() const { return light_left_; }

 private:
  void find_triangles(const TopScene& scene);
  void read_textures();
  void trace_packets(RTCScene scene, const CameraRays& rays, int tile, const BlockSets& blocks,
                     const float* farthest, const FilledBlocks& filled, const KnownTriangles& known,
                     PacketSet hidden);
  std::size_t take_known(const TriangleName* names, const BlockAnswers& answers, std::size_t block,
                         std::size_t packet, std::size_t count);
  std::size_t fill_block(std::size_t block, const FilledBlock& with, PacketSet left_out,
                         std::size_t count);
  void refine_hits(const TopScene& scene, const RayOrigins& origins, const CameraRays& rays,
                   std::size_t base);
  RunRays run_rays(const CameraRays& rays, std::size_t base, std::size_t first, std::size_t count);
  void gather(const TopScene& scene, const CameraRays& rays, int tile, bool points);
  void gather_run(const Instance& instance, const MeshGeometry::Part& part, const RunRays& d,
                  std::size_t first, std::size_t count);
  void gather_hit(const Instance& instance, const MeshGeometry::Part& part, const CameraRays& rays,
                  std::size_t base, std::size_t i);
  void gather_point(const Instance& instance, std::size_t i);
  void test_suns(const LightTable& lights, const Casters& casters);

  TileHits hits_{};
  ShadeInput input_{};
  std::array<float, kTileSamples> side_{};  // of the normals, see normalise()
  std::array<std::array<float, kTileSamples>, 3> run_rays_{};
  // Hits whose colour is a texture's, and where in it.
  struct TexturedHits {
    std::size_t count = 0;
    std::array<std::uint8_t, kTileSamples> hit;
    std::array<const std::uint8_t*, kTileSamples> texels;  // RGBA bytes, row by row
    alignas(64) std::array<std::uint32_t, kTileSamples> upper_left, upper_right, lower_left,
        lower_right;
    alignas(64) std::array<float, kTileSamples> across, down;
  };
  TexturedHits textured_{};
  ShadeOutput output_{};
  SurfacePoints points_{};  // of the hits, only where light is traced
  LightFactors factors_;
  std::vector<std::array<float, kTileSamples>> visible_;  // per sun
  std::array<float, kTileSamples> open_{}, light_left_{};
};

}  // namespace probe::render
