#include "runtime/render/tile_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/render/clones.h"
#include "runtime/render/vec4.h"
#include "runtime/scene/color.h"

namespace probe::render {
namespace {

// The reference shades robot links with this, whatever their files say.
constexpr float kRobotRoughness = 0.3f;
constexpr float kRobotF0 = 0.9f * 0.08f;

// Moller and Trumbore in the mesh frame. A grazing hit whose numbers cannot be trusted keeps
// Embree's.
inline void refine(const TriangleData& triangle, Vec4 origin, Vec4 d, float& t, float& u,
                   float& v) {
  const Vec4 e1 = load4(triangle.e1), e2 = load4(triangle.e2);
  const Vec4 p = cross3(d, e2);
  const Vec4 s = origin - load4(triangle.p0);
  const Vec4 q = cross3(s, e1);
  const float inverse = 1.0f / dot3(e1, p);
  const float exact_t = dot3(e2, q) * inverse;
  if (!(std::abs(exact_t - t) < 1e-3f)) return;
  t = exact_t;
  u = std::clamp(dot3(s, p) * inverse, 0.0f, 1.0f);
  v = std::clamp(dot3(d, q) * inverse, 0.0f, 1.0f - u);
}

// A direction in world, in the mesh frame.
inline Vec4 to_mesh(const Instance& instance, float x, float y, float z) {
  return load4(instance.rows[0]) * splat(x) + load4(instance.rows[1]) * splat(y) +
         load4(instance.rows[2]) * splat(z);
}
inline Vec4 to_world(const Instance& instance, Vec4 d) {
  return load4(instance.columns[0]) * splat(d[0]) + load4(instance.columns[1]) * splat(d[1]) +
         load4(instance.columns[2]) * splat(d[2]);
}

// Normals, not yet of unit length, are divided by their length; `side` is -1 where they turn away
// from the viewer.
PROBE_CLONES void normalise(float* __restrict nx, float* __restrict ny, float* __restrict nz,
                            const float* __restrict side, int count) {
  for (int i = 0; i < count; ++i) {
    const float x = nx[i], y = ny[i], z = nz[i];
    const float square = x * x + y * y + z * z;
    const float scale = side[i] / std::sqrt(square < 1e-20f ? 1e-20f : square);
    nx[i] = x * scale;
    ny[i] = y * scale;
    nz[i] = z * scale;
  }
}

}  // namespace

// Every lane's numbers are written, and the place moves on only behind a hit: no branch to guess.
void TileTracer::trace_packets(RTCScene scene, const CameraRays& rays, std::size_t base,
                               const BlockSets& blocks, const float* farthest) {
  constexpr std::size_t n = 8;
  alignas(32) static constexpr int kAll[n] = {-1, -1, -1, -1, -1, -1, -1, -1};
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) RTCRayHit8 packet;
  for (std::size_t k = 0; k < n; ++k) {
    packet.ray.org_x[k] = rays.origin[0];
    packet.ray.org_y[k] = rays.origin[1];
    packet.ray.org_z[k] = rays.origin[2];
    packet.ray.tnear[k] = kNearest;
    packet.ray.time[k] = 0;
    packet.ray.id[k] = 0;
    packet.ray.flags[k] = 0;
  }
  std::size_t count = 0;
  for (std::size_t block = 0; block < 4; ++block) {
    if (blocks[block] == 0) continue;
    std::fill_n(packet.ray.mask, n, blocks[block]);
    for (std::size_t first = 64 * block; first < 64 * (block + 1); first += n) {
      const std::size_t from = base + first;
      std::memcpy(packet.ray.dir_x, rays.dx.data() + from, sizeof(float) * n);
      std::memcpy(packet.ray.dir_y, rays.dy.data() + from, sizeof(float) * n);
      std::memcpy(packet.ray.dir_z, rays.dz.data() + from, sizeof(float) * n);
      std::memcpy(packet.ray.tfar, farthest + first, sizeof(float) * n);
      std::fill_n(packet.hit.geomID, n, RTC_INVALID_GEOMETRY_ID);
      std::fill_n(packet.hit.instID[0], n, RTC_INVALID_GEOMETRY_ID);
      rtcIntersect8(kAll, scene, &context, &packet);
      for (std::size_t k = 0; k < n; ++k) {
        hits_.sample[count] = static_cast<std::uint8_t>(first + k);
        hits_.instance[count] = packet.hit.instID[0][k];
        hits_.part[count] = packet.hit.geomID[k];
        hits_.primitive[count] = packet.hit.primID[k];
        hits_.t[count] = packet.ray.tfar[k];
        hits_.u[count] = packet.hit.u[k];
        hits_.v[count] = packet.hit.v[k];
        count += packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
      }
    }
  }
  hits_.count = static_cast<int>(count);
}

void TileTracer::trace(const TopScene& scene, const RayOrigins& origins, const CameraRays& rays,
                       int tile, const BlockSets& blocks, const float* farthest) {
  const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
  trace_packets(scene.scene(), rays, base, blocks, farthest);
  find_triangles(scene);
  for (std::size_t i = 0; i < static_cast<std::size_t>(hits_.count); ++i) {
    const Instance& instance = scene.instances()[hits_.instance[i]];
    const std::size_t ray = base + hits_.sample[i];
    const Vec4 d = to_mesh(instance, rays.dx[ray], rays.dy[ray], rays.dz[ray]);
    refine(*hits_.triangle[i], load4(origins.of(hits_.instance[i])), d, hits_.t[i], hits_.u[i],
           hits_.v[i]);
  }
}

// Records lie all over the memory: asked for together, they come while the first is worked on.
void TileTracer::find_triangles(const TopScene& scene) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(hits_.count); ++i) {
    const MeshGeometry& geometry = *scene.instances()[hits_.instance[i]].geometry;
    const TriangleData* triangle =
        geometry.parts[hits_.part[i]].triangles.data() + hits_.primitive[i];
    hits_.triangle[i] = triangle;
    __builtin_prefetch(triangle);
    __builtin_prefetch(reinterpret_cast<const char*>(triangle) + 64);
  }
}

void TileTracer::drop(const std::array<bool, kTileSamples>& hidden) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(hits_.count); ++i) {
    hits_.sample[count] = hits_.sample[i];
    hits_.instance[count] = hits_.instance[i];
    hits_.part[count] = hits_.part[i];
    hits_.primitive[count] = hits_.primitive[i];
    hits_.triangle[count] = hits_.triangle[i];
    hits_.t[count] = hits_.t[i];
    hits_.u[count] = hits_.u[i];
    hits_.v[count] = hits_.v[i];
    count += hidden[hits_.sample[count]] ? 0 : 1;
  }
  hits_.count = static_cast<int>(count);
}

void StoredHits::add_tile(const TileHits& tile) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(tile.count); ++i) {
    hits.push_back({tile.sample[i], tile.instance[i], tile.part[i], tile.primitive[i], tile.t[i],
                    tile.u[i], tile.v[i]});
  }
  first.push_back(static_cast<std::uint32_t>(hits.size()));
}

void TileTracer::take(const TopScene& scene, const StoredHits& stored, int tile,
                      const BlockSets& blocks, const std::array<bool, kTileSamples>& hidden) {
  std::size_t count = 0;
  const auto at = static_cast<std::size_t>(tile);
  for (std::size_t k = stored.first[at]; k < stored.first[at + 1]; ++k) {
    const StoredHits::Hit& hit = stored.hits[k];
    if (blocks[hit.sample / 64] == 0 || hidden[hit.sample]) continue;
    hits_.sample[count] = hit.sample;
    hits_.instance[count] = hit.instance;
    hits_.part[count] = hit.part;
    hits_.primitive[count] = hit.primitive;
    hits_.t[count] = hit.t;
    hits_.u[count] = hit.u;
    hits_.v[count] = hit.v;
    ++count;
  }
  hits_.count = static_cast<int>(count);
  find_triangles(scene);
}

void TileTracer::gather(const TopScene& scene, const CameraRays& rays, int tile, bool points) {
  const std::size_t base = static_cast<std::size_t>(tile) * kTileSamples;
  const auto count = static_cast<std::size_t>(hits_.count);
  textured_count_ = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Instance& instance = scene.instances()[hits_.instance[i]];
    const MeshGeometry::Part& part = instance.geometry->parts[hits_.part[i]];
    const TriangleData& tri = *hits_.triangle[i];
    const std::size_t ray = base + hits_.sample[i];
    const float u = hits_.u[i], v = hits_.v[i], w = 1 - u - v;
    const Vec4 d{rays.dx[ray], rays.dy[ray], rays.dz[ray], 0};
    const Vec4 g = to_world(instance, load4(tri.g));
    const float side = dot3(g, d) > 0 ? -1.0f : 1.0f;
    const Vec4 n = to_world(
        instance, splat(w) * load4(tri.n0) + splat(u) * load4(tri.n1) + splat(v) * load4(tri.n2));
    side_[i] = side;
    input_.nx[i] = n[0];
    input_.ny[i] = n[1];
    input_.nz[i] = n[2];
    input_.vx[i] = -d[0];
    input_.vy[i] = -d[1];
    input_.vz[i] = -d[2];

    const scene::Material& material = part.material;
    input_.albedo_r[i] = material.base_color[0];
    input_.albedo_g[i] = material.base_color[1];
    input_.albedo_b[i] = material.base_color[2];
    scene::LinearRgb emission{material.emission[0], material.emission[1], material.emission[2]};
    if (part.base_color != nullptr || part.emission != nullptr) {
      const float tu = w * tri.uv0[0] + u * tri.uv1[0] + v * tri.uv2[0];
      const float tv = w * tri.uv0[1] + u * tri.uv1[1] + v * tri.uv2[1];
      if (part.base_color != nullptr) {
        const scene::Footprint at = scene::footprint_at(*part.base_color, tu, tv);
        __builtin_prefetch(at.upper + at.left);
        __builtin_prefetch(at.lower + at.left);
        footprints_[textured_count_] = at;
        textured_[textured_count_++] = static_cast<std::uint8_t>(i);
      }
      if (part.emission != nullptr) emission = scene::sample_texture(*part.emission, tu, tv);
    }
    input_.emission_r[i] = emission.r;
    input_.emission_g[i] = emission.g;
    input_.emission_b[i] = emission.b;
    input_.roughness[i] = instance.robot ? kRobotRoughness : material.roughness;
    input_.f0[i] = instance.robot ? kRobotF0 : material.f0;
    input_.metallic[i] = instance.robot ? 0.0f : material.metallic;

    if (points) {
      const Vec4 p =
          to_world(instance, load4(tri.p0) + splat(u) * load4(tri.e1) + splat(v) * load4(tri.e2));
      points_.px[i] = p[0] + instance.translation[0];
      points_.py[i] = p[1] + instance.translation[1];
      points_.pz[i] = p[2] + instance.translation[2];
      points_.gx[i] = g[0] * side;
      points_.gy[i] = g[1] * side;
      points_.gz[i] = g[2] * side;
    }
  }
  read_textures();
  normalise(input_.nx.data(), input_.ny.data(), input_.nz.data(), side_.data(), hits_.count);
  pad(input_, hits_.count);
}

void TileTracer::read_textures() {
  for (std::size_t k = 0; k < textured_count_; ++k) {
    const std::size_t i = textured_[k];
    const scene::LinearRgb albedo = scene::sample_at(footprints_[k]);
    input_.albedo_r[i] = albedo.r;
    input_.albedo_g[i] = albedo.g;
    input_.albedo_b[i] = albedo.b;
  }
}

void TileTracer::test_suns(const LightTable& lights, const Casters& casters) {
  visible_.resize(lights.suns.size());
  factors_.visible.clear();
  for (std::size_t s = 0; s < lights.suns.size(); ++s) {
    const bool cast = lights.suns[s].shadow;
    if (cast) {
      test_sun(casters, lights.suns[s], input_, points_, hits_.count, visible_[s]);
    }
    factors_.visible.push_back(cast ? visible_[s].data() : nullptr);
  }
}

void TileTracer::shade(const TopScene& scene, const CameraRays& rays, int tile,
                       const LightTable& lights, const Occlusion& occlusion) {
  const bool shadows = lights.any_shadow();
  gather(scene, rays, tile, shadows || occlusion.rays > 0);
  factors_.visible.clear();
  factors_.open = nullptr;
  if (shadows) test_suns(lights, occlusion.suns);
  if (occlusion.rays > 0) {
    std::array<std::uint32_t, kTileSamples> seeds;
    const auto left = static_cast<std::uint32_t>(tile % rays.tiles_x * kTileSide);
    const auto top = static_cast<std::uint32_t>(tile / rays.tiles_x * kTileSide);
    const auto count = static_cast<std::size_t>(hits_.count);
    for (std::size_t i = 0; i < count; ++i) {
      const TileOffset at = kTileOffsets[hits_.sample[i]];
      seeds[i] = place_hash(left + at.x, top + at.y);
    }
    test_openness(occlusion.ambient, input_, points_, {seeds.data(), count}, occlusion.rays, open_);
    factors_.open = open_.data();
  }
  render::shade(input_, hits_.count, lights, factors_, output_);
}

void TileTracer::catch_shadow(const TopScene& scene, const CameraRays& rays, int tile,
                              const LightTable& lights, const TopScene& dynamics) {
  constexpr float kPiHere = 3.14159265358979323846f;
  gather(scene, rays, tile, true);
  test_suns(lights, {&dynamics, nullptr});
  for (std::size_t i = 0; i < static_cast<std::size_t>(hits_.count); ++i) {
    float all = lights.ambient, left = lights.ambient;
    for (std::size_t s = 0; s < lights.suns.size(); ++s) {
      const LightRay& sun = lights.suns[s];
      const float facing = input_.nx[i] * sun.x + input_.ny[i] * sun.y + input_.nz[i] * sun.z;
      const float light = sun.irradiance * std::clamp(facing, 0.0f, 1.0f) / kPiHere;
      all += light;
      // A face turned away was dark in the photo too.
      const bool away = points_.gx[i] * sun.x + points_.gy[i] * sun.y + points_.gz[i] * sun.z <= 0;
      if (away || factors_.visible[s] == nullptr || factors_.visible[s][i] > 0) left += light;
    }
    light_left_[i] = all > 0 ? left / all : 1;
  }
}

}  // namespace probe::render
