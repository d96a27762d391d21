#include "runtime/render/occlusion.h"

#include <cmath>
#include <numbers>

#include "runtime/base/trig.h"

namespace probe::render {
namespace {

constexpr float kBias = 0.0002f;      // m along the face normal
constexpr float kShadowReach = 5.0f;  // m
constexpr float kOpenReach = 0.15f;   // m
constexpr std::size_t kTurns = 256;

struct Direction {
  float x, y, z;
};

// Collects rays until eight are there, then asks every scene; `blocked` hears of each ray that met
// something.
template <typename Blocked>
class OcclusionPacket {
 public:
  OcclusionPacket(const Casters& casters, float reach, Blocked blocked)
      : casters_(casters), reach_(reach), blocked_(blocked) {
    rtcInitIntersectContext(&context_);
    for (std::size_t k = 0; k < 8; ++k) {
      packet_.org_x[k] = packet_.org_y[k] = packet_.org_z[k] = 0;
      packet_.dir_x[k] = packet_.dir_y[k] = 0;
      packet_.dir_z[k] = 1;
      packet_.time[k] = 0;
      packet_.mask[k] = ~0u;
      packet_.id[k] = 0;
      packet_.flags[k] = 0;
    }
  }

  void add(const SurfacePoints& points, std::size_t i, const Direction& d) {
    packet_.org_x[lanes_] = points.px[i] + kBias * points.gx[i];
    packet_.org_y[lanes_] = points.py[i] + kBias * points.gy[i];
    packet_.org_z[lanes_] = points.pz[i] + kBias * points.gz[i];
    packet_.dir_x[lanes_] = d.x;
    packet_.dir_y[lanes_] = d.y;
    packet_.dir_z[lanes_] = d.z;
    owner_[lanes_++] = i;
    if (lanes_ == 8) flush();
  }

  void flush() {
    if (lanes_ == 0) return;
    for (std::size_t k = 0; k < 8; ++k) {
      const bool used = k < lanes_;
      valid_[k] = used ? -1 : 0;
      packet_.tnear[k] = used ? 0.0f : 1.0f;
      packet_.tfar[k] = used ? reach_ : 0.0f;
    }
    for (const TopScene* scene : {casters_.dynamics, casters_.statics}) {
      if (scene == nullptr || scene->empty()) continue;
      rtcOccluded8(valid_, scene->scene(), &context_, &packet_);
      for (std::size_t k = 0; k < lanes_; ++k) {
        if (packet_.tfar[k] < 0) valid_[k] = 0;
      }
    }
    for (std::size_t k = 0; k < lanes_; ++k) {
      if (packet_.tfar[k] < 0) blocked_(owner_[k]);
    }
    lanes_ = 0;
  }

 private:
  Casters casters_;
  float reach_;
  Blocked blocked_;
  RTCIntersectContext context_;
  alignas(32) RTCRay8 packet_;
  alignas(32) int valid_[8];
  std::size_t owner_[8] = {};
  std::size_t lanes_ = 0;
};

// Unit vectors round a circle.
const std::array<std::array<float, 2>, kTurns>& turns() {
  static const auto kTable = [] {
    std::array<std::array<float, 2>, kTurns> table;
    constexpr double kPi = std::numbers::pi;
    for (std::size_t i = 0; i < kTurns; ++i) {
      const SinCos turn = portable_sincos(2 * kPi * static_cast<double>(i) / kTurns);
      table[i] = {static_cast<float>(turn.cos), static_cast<float>(turn.sin)};
    }
    return table;
  }();
  return kTable;
}

// Two unit vectors square to n and to each other (Duff and others, JCGT 6(1), 2017).
void square_to(const Direction& n, Direction& a, Direction& b) {
  const float sign = n.z < 0 ? -1.0f : 1.0f;
  const float k = -1.0f / (sign + n.z);
  const float m = n.x * n.y * k;
  a = {1.0f + sign * n.x * n.x * k, sign * m, -sign * n.x};
  b = {m, sign + n.y * n.y * k, -n.y};
}

}  // namespace

void test_sun(const Casters& casters, const LightRay& sun, const ShadeInput& input,
              const SurfacePoints& points, int count, std::array<float, kTileSamples>& visible) {
  visible.fill(1);
  OcclusionPacket packet(casters, kShadowReach, [&](std::size_t i) { visible[i] = 0; });
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const float facing = input.nx[i] * sun.x + input.ny[i] * sun.y + input.nz[i] * sun.z;
    if (!(facing > 0)) continue;
    if (points.gx[i] * sun.x + points.gy[i] * sun.y + points.gz[i] * sun.z <= 0) {
      visible[i] = 0;
      continue;
    }
    packet.add(points, i, {sun.x, sun.y, sun.z});
  }
  packet.flush();
}

void test_openness(const Casters& casters, const ShadeInput& input, const SurfacePoints& points,
                   std::span<const std::uint32_t> seeds, int rays,
                   std::array<float, kTileSamples>& open) {
  open.fill(1);
  const float share = 1.0f / static_cast<float>(rays);
  OcclusionPacket packet(casters, kOpenReach, [&](std::size_t i) { open[i] -= share; });
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Direction n{input.nx[i], input.ny[i], input.nz[i]};
    Direction a{}, b{};
    square_to(n, a, b);
    for (int q = 0; q < rays; ++q) {
      // Stratified height, golden-ratio steps round the circle (158 of 256 is 0.618 of a turn).
      const float u = (static_cast<float>(q) + 0.5f) * share;
      const float across = std::sqrt(u), along = std::sqrt(1.0f - u);
      const auto& turn = turns()[(seeds[i] + 158u * static_cast<std::uint32_t>(q)) % kTurns];
      const float x = across * turn[0], y = across * turn[1];
      packet.add(points, i,
                 {x * a.x + y * b.x + along * n.x, x * a.y + y * b.y + along * n.y,
                  x * a.z + y * b.z + along * n.z});
    }
  }
  packet.flush();
  // Sums of shares can end a rounding below zero.
  for (std::size_t i = 0; i < seeds.size(); ++i) open[i] = open[i] < 0 ? 0 : open[i];
}

std::uint32_t place_hash(std::uint32_t x, std::uint32_t y) {
  std::uint32_t h = x * 0x9E3779B1u ^ y * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 12;
  h *= 0x297A2D39u;
  return h ^ h >> 15;
}

}  // namespace probe::render
