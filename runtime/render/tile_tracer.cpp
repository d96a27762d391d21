#include "runtime/render/tile_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
  if (!(std::abs(exact_t - t) < 1e-3f) && t != kUnknownDistance) return;
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

// Cloned, so that rays are written in registers as wide as those in which Embree reads: what was
// written in halves is slow to read as a whole.
PROBE_CLONES void load_rays(const float* __restrict dx, const float* __restrict dy,
                            const float* __restrict dz, const float* __restrict farthest,
                            InstanceSet set, RTCRayHit8& __restrict packet) {
  for (std::size_t k = 0; k < 8; ++k) {
    packet.ray.dir_x[k] = dx[k];
    packet.ray.dir_y[k] = dy[k];
    packet.ray.dir_z[k] = dz[k];
    packet.ray.tfar[k] = farthest[k];
    packet.ray.mask[k] = set;
    packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
}

}  // namespace

// Every lane's numbers are written, and the place moves on only behind a hit: no branch to guess.
void TileTracer::trace_packets(RTCScene scene, const CameraRays& rays, int tile,
                               const BlockSets& blocks, const float* farthest,
                               const FilledBlocks& filled, const KnownTriangles& known,
                               PacketSet hidden) {
  const std::size_t base = rays.base(tile);
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
  BlockAnswers answers;
  for (std::size_t block = 0; block < 4; ++block) {
    if (blocks[block] == 0) continue;
    const PacketSet left_out = hidden >> (8 * block) & 0xFF;
    if (left_out == 0xFF) continue;
    if (filled[block].filled) {
      count = fill_block(block, filled[block], left_out, count);
      continue;
    }
    const bool is_known = known.has(blocks[block]);
    if (is_known) {
      const int part = static_cast<int>(block);
      known.sheet->answer(2 * (tile % rays.tiles_x - known.tile_x) + part % 2,
                          2 * (tile / rays.tiles_x - known.tile_y) + part / 2,
                          farthest + 64 * block, rays.cosine.data() + base + 64 * block, answers);
    }
    for (std::size_t first = 64 * block; first < 64 * (block + 1); first += n) {
      const std::size_t from = base + first;
      const std::size_t p = (first - 64 * block) / n;
      if ((left_out >> p & 1) != 0) continue;
      if (is_known && answers.settled(p)) {
        count = take_known(known.names, answers, block, p, count);
        continue;
      }
      load_rays(rays.dx.data() + from, rays.dy.data() + from, rays.dz.data() + from,
                farthest + first, blocks[block], packet);
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

// Behind the hits so far, whose number it gives with its own.
std::size_t TileTracer::take_known(const TriangleName* names, const BlockAnswers& answers,
                                   std::size_t block, std::size_t packet, std::size_t count) {
  for (std::size_t k = 0; k < 8; ++k) {
    if (answers.hit[8 * packet + k] == 0) continue;
    const TriangleName& name = names[answers.triangle(packet, k)];
    hits_.sample[count] = static_cast<std::uint8_t>(64 * block + 8 * packet + k);
    hits_.instance[count] = name.instance;
    hits_.part[count] = name.part;
    hits_.primitive[count] = name.primitive;
    hits_.t[count] = kUnknownDistance;
    hits_.u[count] = hits_.v[count] = 0;
    ++count;
  }
  return count;
}

// The same of a whole block, but for packets that are left out.
std::size_t TileTracer::fill_block(std::size_t block, const FilledBlock& with, PacketSet left_out,
                                   std::size_t count) {
  const std::size_t begin = count;
  for (std::size_t packet = 0; packet < 8; ++packet) {
    if ((left_out >> packet & 1) != 0) continue;
    for (std::size_t k = 0; k < 8; ++k)
      hits_.sample[count + k] = static_cast<std::uint8_t>(64 * block + 8 * packet + k);
    count += 8;
  }
  const std::size_t all = count - begin;
  std::fill_n(&hits_.instance[begin], all, with.name.instance);
  std::fill_n(&hits_.part[begin], all, with.name.part);
  std::fill_n(&hits_.primitive[begin], all, with.name.primitive);
  std::fill_n(&hits_.t[begin], all, kUnknownDistance);
  std::fill_n(&hits_.u[begin], all, 0.0f);
  std::fill_n(&hits_.v[begin], all, 0.0f);
  return count;
}

void TileTracer::trace(const TopScene& scene, const RayOrigins& origins, const CameraRays& rays,
                       int tile, const BlockSets& blocks, const float* farthest,
                       const FilledBlocks& filled, const KnownTriangles& known, PacketSet hidden) {
  trace_packets(scene.scene(), rays, tile, blocks, farthest, filled, known, hidden);
  find_triangles(scene);
  refine_hits(scene, origins, rays, rays.base(tile));
}

void TileTracer::refine_hits(const TopScene& scene, const RayOrigins& origins,
                             const CameraRays& rays, std::size_t base) {
  const auto count = static_cast<std::size_t>(hits_.count);
  for (std::size_t first = 0, n = 0; first < count; first += n) {
    n = hits_.run(first);
    const TriangleData& triangle = *hits_.triangle[first];
    const Instance& instance = scene.instances()[hits_.instance[first]];
    const float* origin = origins.of(hits_.instance[first]);
    if (n >= kLongRun) {
      refine_run(triangle, instance, origin, run_rays(rays, base, first, n), n, &hits_.t[first],
                 &hits_.u[first], &hits_.v[first]);
      continue;
    }
    for (std::size_t i = first; i < first + n; ++i) {
      const std::size_t ray = base + hits_.sample[i];
      const Vec4 d = to_mesh(instance, rays.dx[ray], rays.dy[ray], rays.dz[ray]);
      refine(triangle, load4(origin), d, hits_.t[i], hits_.u[i], hits_.v[i]);
    }
  }
}

// In place where no sample between was missed.
RunRays TileTracer::run_rays(const CameraRays& rays, std::size_t base, std::size_t first,
                             std::size_t count) {
  const std::size_t from = base + hits_.sample[first];
  if (hits_.sample[first + count - 1] - hits_.sample[first] + std::size_t{1} == count) {
    return {&rays.dx[from], &rays.dy[from], &rays.dz[from]};
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t ray = base + hits_.sample[first + i];
    run_rays_[0][i] = rays.dx[ray];
    run_rays_[1][i] = rays.dy[ray];
    run_rays_[2][i] = rays.dz[ray];
  }
  return {run_rays_[0].data(), run_rays_[1].data(), run_rays_[2].data()};
}

// Records lie all over the memory: asked for together, they come while the first is worked on.
void TileTracer::find_triangles(const TopScene& scene) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(hits_.count); ++i) {
    if (i > 0 && hits_.primitive[i] == hits_.primitive[i - 1] &&
        hits_.instance[i] == hits_.instance[i - 1] && hits_.part[i] == hits_.part[i - 1]) {
      hits_.triangle[i] = hits_.triangle[i - 1];
      continue;
    }
    const MeshGeometry& geometry = *scene.instances()[hits_.instance[i]].geometry;
    const TriangleData* triangle =
        geometry.parts[hits_.part[i]].triangles.data() + hits_.primitive[i];
    hits_.triangle[i] = triangle;
    __builtin_prefetch(triangle);
    __builtin_prefetch(reinterpret_cast<const char*>(triangle) + 64);
  }
}

void TileTracer::drop(const std::array<bool, kTileSamples>& hidden) {
  const auto all = static_cast<std::size_t>(hits_.count);
  std::size_t count = 0, end = 0;
  for (std::size_t first = 0; first < all; first = end) {
    const bool is_hidden = hidden[hits_.sample[first]];
    end = first + 1;
    while (end < all && hidden[hits_.sample[end]] == is_hidden) ++end;
    if (is_hidden) continue;
    if (count < first) hits_.move(first, end, count);
    count += end - first;
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
  const std::size_t base = rays.base(tile);
  const auto count = static_cast<std::size_t>(hits_.count);
  textured_.count = 0;
  for (std::size_t first = 0, n = 0; first < count; first += n) {
    n = hits_.run(first);
    const Instance& instance = scene.instances()[hits_.instance[first]];
    const MeshGeometry::Part& part = instance.geometry->parts[hits_.part[first]];
    if (n >= kLongRun && part.emission == nullptr) {
      gather_run(instance, part, run_rays(rays, base, first, n), first, n);
    } else {
      for (std::size_t i = first; i < first + n; ++i) gather_hit(instance, part, rays, base, i);
    }
    if (!points) continue;
    for (std::size_t i = first; i < first + n; ++i) gather_point(instance, i);
  }
  read_textures();
  normalise(input_.nx.data(), input_.ny.data(), input_.nz.data(), side_.data(), hits_.count);
  pad(input_, hits_.count);
}

void TileTracer::gather_run(const Instance& instance, const MeshGeometry::Part& part,
                            const RunRays& d, std::size_t first, std::size_t count) {
  const TriangleData& triangle = *hits_.triangle[first];
  const float *u = &hits_.u[first], *v = &hits_.v[first];
  turn_run(triangle, instance, d, count, u, v,
           {&input_.nx[first], &input_.ny[first], &input_.nz[first], &side_[first],
            &input_.vx[first], &input_.vy[first], &input_.vz[first]});
  const scene::Material& material = part.material;
  const auto fill = [first, count](ShadeInput::Array& array, float value) {
    std::fill_n(array.data() + first, count, value);
  };
  if (part.base_color != nullptr) {
    const std::size_t k = textured_.count;
    place_run(triangle, *part.base_color, count, u, v,
              {&textured_.upper_left[k], &textured_.upper_right[k], &textured_.lower_left[k],
               &textured_.lower_right[k], &textured_.across[k], &textured_.down[k]});
    const std::uint8_t* texels = part.base_color->rgba.data();
    for (std::size_t i = 0; i < count; ++i) {
      textured_.hit[k + i] = static_cast<std::uint8_t>(first + i);
      textured_.texels[k + i] = texels;
      __builtin_prefetch(texels + 4 * std::size_t{textured_.upper_left[k + i]});
      __builtin_prefetch(texels + 4 * std::size_t{textured_.lower_left[k + i]});
    }
    textured_.count += count;
  } else {
    fill(input_.albedo_r, material.base_color[0]);
    fill(input_.albedo_g, material.base_color[1]);
    fill(input_.albedo_b, material.base_color[2]);
  }
  fill(input_.emission_r, material.emission[0]);
  fill(input_.emission_g, material.emission[1]);
  fill(input_.emission_b, material.emission[2]);
  fill(input_.roughness, instance.robot ? kRobotRoughness : material.roughness);
  fill(input_.f0, instance.robot ? kRobotF0 : material.f0);
  fill(input_.metallic, instance.robot ? 0.0f : material.metallic);
}

void TileTracer::gather_hit(const Instance& instance, const MeshGeometry::Part& part,
                            const CameraRays& rays, std::size_t base, std::size_t i) {
  const TriangleData& tri = *hits_.triangle[i];
  const std::size_t ray = base + hits_.sample[i];
  const float u = hits_.u[i], v = hits_.v[i], w = 1 - u - v;
  const Vec4 d{rays.dx[ray], rays.dy[ray], rays.dz[ray], 0};
  const Vec4 g = to_world(instance, load4(tri.g));
  const Vec4 n = to_world(
      instance, splat(w) * load4(tri.n0) + splat(u) * load4(tri.n1) + splat(v) * load4(tri.n2));
  side_[i] = dot3(g, d) > 0 ? -1.0f : 1.0f;
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
      const scene::Texture& texture = *part.base_color;
      const scene::Texels at = scene::texels_at(texture.width, texture.height, tu, tv);
      const auto width = static_cast<std::uint32_t>(texture.width);
      const std::uint32_t upper = width * static_cast<std::uint32_t>(at.y0);
      const std::uint32_t lower = width * static_cast<std::uint32_t>(at.y1);
      const std::size_t k = textured_.count++;
      textured_.hit[k] = static_cast<std::uint8_t>(i);
      textured_.texels[k] = texture.rgba.data();
      textured_.upper_left[k] = upper + static_cast<std::uint32_t>(at.x0);
      textured_.upper_right[k] = upper + static_cast<std::uint32_t>(at.x1);
      textured_.lower_left[k] = lower + static_cast<std::uint32_t>(at.x0);
      textured_.lower_right[k] = lower + static_cast<std::uint32_t>(at.x1);
      textured_.across[k] = at.across;
      textured_.down[k] = at.down;
      __builtin_prefetch(texture.rgba.data() + 4 * std::size_t{textured_.upper_left[k]});
      __builtin_prefetch(texture.rgba.data() + 4 * std::size_t{textured_.lower_left[k]});
    }
    if (part.emission != nullptr) emission = scene::sample_texture(*part.emission, tu, tv);
  }
  input_.emission_r[i] = emission.r;
  input_.emission_g[i] = emission.g;
  input_.emission_b[i] = emission.b;
  input_.roughness[i] = instance.robot ? kRobotRoughness : material.roughness;
  input_.f0[i] = instance.robot ? kRobotF0 : material.f0;
  input_.metallic[i] = instance.robot ? 0.0f : material.metallic;
}

// Where light is traced from; `side_` is known.
void TileTracer::gather_point(const Instance& instance, std::size_t i) {
  const TriangleData& tri = *hits_.triangle[i];
  const Vec4 g = to_world(instance, load4(tri.g));
  const Vec4 p = to_world(instance, load4(tri.p0) + splat(hits_.u[i]) * load4(tri.e1) +
                                        splat(hits_.v[i]) * load4(tri.e2));
  points_.px[i] = p[0] + instance.translation[0];
  points_.py[i] = p[1] + instance.translation[1];
  points_.pz[i] = p[2] + instance.translation[2];
  points_.gx[i] = g[0] * side_[i];
  points_.gy[i] = g[1] * side_[i];
  points_.gz[i] = g[2] * side_[i];
}

void TileTracer::read_textures() {
  const std::uint8_t* last = nullptr;
  scene::DecodedTexels decoded{};
  for (std::size_t k = 0; k < textured_.count; ++k) {
    const std::size_t i = textured_.hit[k];
    const auto texel = [&](std::uint32_t index) {
      return scene::decode(textured_.texels[k] + 4 * std::size_t{index});
    };
    // From near, neighbours lie between the same four texels.
    const std::uint8_t* here = textured_.texels[k] + 4 * std::size_t{textured_.upper_left[k]};
    if (here != last) {
      decoded = {texel(textured_.upper_left[k]), texel(textured_.upper_right[k]),
                 texel(textured_.lower_left[k]), texel(textured_.lower_right[k])};
      last = here;
    }
    const scene::LinearRgb albedo =
        scene::mix_texels(decoded, textured_.across[k], textured_.down[k]);
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
  constexpr float kPiHere = std::numbers::pi_v<float>;
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
