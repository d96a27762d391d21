#include "runtime/render/vertex_law.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {

PROBE_CLONES void PowerTable::read_all(const float* __restrict values, const float* __restrict x,
                                       std::size_t count, float* __restrict powers) {
  for (std::size_t i = 0; i < count; ++i) {
    float inside = x[i];
    inside = inside < 0.0f ? 0.0f : inside;
    powers[i] = 1.0f < inside ? 1.0f : inside;
  }
  for (std::size_t i = 0; i < count; ++i) powers[i] = read(values, powers[i]);
}

namespace {

// Natural logarithm of x in (0, 1] and e^x of x <= 0, by series of + - * / alone: the same bits
// with every C library.
double log_of(double x) {
  int exponent = 0;
  const double m = std::frexp(x, &exponent);  // [0.5, 1)
  const double t = (m - 0.75) / (m + 0.75), t2 = t * t;
  double sum = 0;
  for (int k = 25; k >= 1; k -= 2) sum = sum * t2 + 1.0 / k;
  constexpr double kLog2 = 0.69314718055994530942, kLogThreeQuarters = -0.28768207245178092744;
  return exponent * kLog2 + kLogThreeQuarters + 2 * t * sum;
}

double exp_of(double x) {
  constexpr double kLog2 = 0.69314718055994530942;
  const double whole = std::floor(x / kLog2);
  const double rest = x - whole * kLog2;
  double sum = 1;
  for (int k = 20; k >= 1; --k) sum = 1 + rest / k * sum;
  return std::ldexp(sum, static_cast<int>(whole));
}

Float3 to_float(const Vec3& v) { return v.cast<float>(); }

std::array<float, 3> times(const std::array<double, 3>& color, double strength) {
  std::array<float, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(color[k] * strength);
  return out;
}

// Some corners, and what has come together of their light.
struct LightBlock {
  static constexpr std::size_t kMost = 128;
  std::size_t count = 0;
  std::array<const float*, 3> position{}, normal{};
  std::array<std::array<float, kMost>, 3> view, light, gloss;  // view: unit, towards the eye
};

PROBE_CLONES void begin_light(LightBlock& block, const Float3& eye,
                              const std::array<float, 3>& ambient) {
  const std::size_t count = block.count;
  const float* __restrict const px = block.position[0];
  const float* __restrict const py = block.position[1];
  const float* __restrict const pz = block.position[2];
  float* __restrict const vx = block.view[0].data();
  float* __restrict const vy = block.view[1].data();
  float* __restrict const vz = block.view[2].data();
  const float ex = eye.x(), ey = eye.y(), ez = eye.z();
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const float x = ex - px[i], y = ey - py[i], z = ez - pz[i];
    const float square = x * x + (y * y + z * z);
    const float root = std::sqrt(square);
    const float length = square > 0 ? root : 1;
    vx[i] = x / length;
    vy[i] = y / length;
    vz[i] = z / length;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    std::fill_n(block.light[k].data(), count, ambient[k]);
    std::fill_n(block.gloss[k].data(), count, 0.0f);
  }
}

struct LampFactors {
  const LampsThere::Lamp& lamp;
  const float* narrowing;
  const float* shine;
  float specular;  // of the material
  std::array<float, 3> place, forward;
};

// Towards a lamp, unit, and what reaches corners of it. Loops do little each, so that compilers
// turn them into vector instructions.
struct LampReach {
  std::array<std::array<float, LightBlock::kMost>, 3> toward;
  std::array<float, LightBlock::kMost> share;
  std::array<float, LightBlock::kMost> fade, facing, along, bright;  // on the way there
};

PROBE_CLONES void reach_of_spot(const LightBlock& block, const LampFactors& by,
                                LampReach& __restrict reach) {
  const std::size_t count = block.count;
  const float* __restrict const px = block.position[0];
  const float* __restrict const py = block.position[1];
  const float* __restrict const pz = block.position[2];
  float* __restrict const to_x = reach.toward[0].data();
  float* __restrict const to_y = reach.toward[1].data();
  float* __restrict const to_z = reach.toward[2].data();
  float* __restrict const share = reach.share.data();
  const std::array<float, 3> place = by.place, forward = by.forward, fade = by.lamp.fade;
  const float cutoff = by.lamp.cutoff_cosine;
  const float* __restrict const narrowing = by.narrowing;
  float* __restrict const along_of = reach.along.data();
  float* __restrict const fade_of = reach.fade.data();
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = place[0] - px[i], dy = place[1] - py[i], dz = place[2] - pz[i];
    const float distance = std::sqrt(dx * dx + (dy * dy + dz * dz));
    const float by_distance = distance > 0 ? distance : 1;
    const float x = dx / by_distance, y = dy / by_distance, z = dz / by_distance;
    to_x[i] = x;
    to_y[i] = y;
    to_z[i] = z;
    along_of[i] = -(x * forward[0] + (y * forward[1] + z * forward[2]));
    fade_of[i] = fade[0] + distance * (fade[1] + distance * fade[2]);
  }
  // Nothing reaches what lies beside a spot: zeros are added, which change no light.
  PowerTable::read_all(narrowing, along_of, count, share);
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const float lit = share[i] / fade_of[i];
    share[i] = along_of[i] < cutoff ? 0.0f : lit;
  }
}

PROBE_CLONES void add_lamp(LightBlock& block, const LampFactors& by, LampReach& __restrict reach) {
  const std::size_t count = block.count;
  const float* __restrict const nx = block.normal[0];
  const float* __restrict const ny = block.normal[1];
  const float* __restrict const nz = block.normal[2];
  const float* __restrict const vx = block.view[0].data();
  const float* __restrict const vy = block.view[1].data();
  const float* __restrict const vz = block.view[2].data();
  const float* __restrict const lx = reach.toward[0].data();
  const float* __restrict const ly = reach.toward[1].data();
  const float* __restrict const lz = reach.toward[2].data();
  const float* __restrict const share = reach.share.data();
  const float* __restrict const shine = by.shine;
  const float of_material = by.specular;
  float* __restrict const facing_of = reach.facing.data();
  float* __restrict const along_of = reach.along.data();
  float* __restrict const bright_of = reach.bright.data();
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    facing_of[i] = nx[i] * lx[i] + (ny[i] * ly[i] + nz[i] * lz[i]);
    const float hx = lx[i] + vx[i], hy = ly[i] + vy[i], hz = lz[i] + vz[i];
    const float square = hx * hx + (hy * hy + hz * hz);
    const float root = std::sqrt(square);
    const float length = square > 0 ? root : 1;
    along_of[i] = nx[i] * (hx / length) + (ny[i] * (hy / length) + nz[i] * (hz / length));
  }
  PowerTable::read_all(shine, along_of, count, bright_of);
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const float bright = share[i] * of_material * bright_of[i];
    bright_of[i] = facing_of[i] > 0 ? bright : 0.0f;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const float ambient = by.lamp.ambient[k], diffuse = by.lamp.diffuse[k],
                specular = by.lamp.specular[k];
    float* __restrict const light = block.light[k].data();
    float* __restrict const gloss = block.gloss[k].data();
    PROBE_INDEPENDENT
    for (std::size_t i = 0; i < count; ++i) {
      const float with_ambient = light[i] + share[i] * ambient;
      const float straight = share[i] * diffuse * facing_of[i];
      light[i] = with_ambient + (facing_of[i] > 0 ? straight : 0.0f);
      gloss[i] += bright_of[i] * specular;
    }
  }
}

// What comes from one direction reaches all.
void reach_of_sun(const LightBlock& block, const LampFactors& by, LampReach& reach) {
  for (std::size_t k = 0; k < 3; ++k) std::fill_n(reach.toward[k].data(), block.count, by.place[k]);
  std::fill_n(reach.share.data(), block.count, 1.0f);
}

PROBE_CLONES void end_light(const LightBlock& block, std::size_t k, float share, float emission,
                            float of_material, float* __restrict color) {
  const float* __restrict const light = block.light[k].data();
  const float* __restrict const gloss = block.gloss[k].data();
  for (std::size_t i = 0; i < block.count; ++i) {
    const float sum = share * (emission + light[i] * of_material) + gloss[i];
    color[i] = sum < 0.0f ? 0.0f : (1.0f < sum ? 1.0f : sum);
  }
}

bool is_strength(double value) { return std::isfinite(value) && value >= 0; }

}  // namespace

PowerTable::PowerTable(double exponent) {
  constexpr double kNothing = -700;  // e^-700 is no float any more
  for (int i = 0; i <= kSteps; ++i) {
    const double x = static_cast<double>(i) / kSteps;
    double value = exponent == 0 ? 1 : 0;
    if (i > 0) {
      const double power = exponent * log_of(x);
      value = power < kNothing ? 0 : exp_of(power);
    }
    values_[static_cast<std::size_t>(i)] = static_cast<float>(value);
  }
  values_[kSteps + 1] = values_[kSteps];
}

Result<LampTable> LampTable::make(const Lights& lights) {
  const auto refuse = [](const char* message) {
    return Failure{.code = Fault::kRender, .message = message, .where = "light"};
  };
  if (!is_strength(lights.ambient)) return refuse("the ambient light is negative or not finite");
  for (const double channel : lights.color) {
    if (!is_strength(channel)) return refuse("a light's colour is negative or not finite");
  }
  if (!lights.suns.empty()) return refuse("`shading vertex` takes lamps, no suns of the other law");
  LampTable table;
  table.lights_ = lights;
  for (Lamp& lamp : table.lights_.lamps) {
    if (!is_strength(lamp.diffuse) || !is_strength(lamp.specular) || !is_strength(lamp.ambient))
      return refuse("a lamp's strength is negative or not finite");
    if (!is_strength(lamp.exponent) || !std::isfinite(lamp.cutoff_cosine) ||
        !lamp.position.allFinite())
      return refuse("a lamp's place, exponent or cutoff is not finite");
    for (const double factor : lamp.fade) {
      if (!is_strength(factor)) return refuse("a lamp fades by factors of 0 or more");
    }
    if (lamp.fade[0] + lamp.fade[1] + lamp.fade[2] <= 0)
      return refuse("a lamp fades by factors of which one is above 0");
    if (lamp.kind != Lamp::Kind::kHeadlight) {
      const double length = lamp.direction.norm();
      if (!std::isfinite(length) || length == 0) return refuse("a lamp has no direction");
      lamp.direction /= length;
    }
    table.narrowing_.push_back(std::make_shared<const PowerTable>(lamp.exponent));
  }
  return table;
}

void LampTable::put(const Pose& place, const Vec3& eye, const Vec3& forward,
                    LampsThere& there) const {
  const Mat3 back = place.rotation.toRotationMatrix().transpose();
  there.eye = to_float(back * (eye - place.position));
  there.ambient = times(lights_.color, lights_.ambient);
  there.lamps.resize(lights_.lamps.size());
  for (std::size_t i = 0; i < lights_.lamps.size(); ++i) {
    const Lamp& from = lights_.lamps[i];
    LampsThere::Lamp& to = there.lamps[i];
    to.is_spot = from.kind == Lamp::Kind::kSpot;
    const Vec3 direction = from.kind == Lamp::Kind::kHeadlight ? forward : from.direction;
    to.place = to_float(back * (to.is_spot ? Vec3(from.position - place.position) : -direction));
    to.forward = to_float(back * direction);
    to.cutoff_cosine = static_cast<float>(from.cutoff_cosine);
    to.narrowing = narrowing_[i].get();
    for (std::size_t k = 0; k < 3; ++k) to.fade[k] = static_cast<float>(from.fade[k]);
    to.diffuse = times(lights_.color, from.diffuse);
    to.specular = times(lights_.color, from.specular);
    to.ambient = times(lights_.color, from.ambient);
  }
}

bool LampsThere::Lamp::may_reach(const Ball& ball) const {
  if (!is_spot || cutoff_cosine <= 0) return true;
  const Float3 there = ball.middle - place;
  const float along = there.dot(forward), beside = (there - along * forward).norm();
  const float sine = std::sqrt(std::max(0.0f, 1 - cutoff_cosine * cutoff_cosine));
  constexpr float kRoom = 1e-3f;  // m, and of the distance: far more than is lost by rounding
  return beside * cutoff_cosine - along * sine <= ball.radius + kRoom * (1 + there.norm());
}

void LampsThere::light(const VertexMaterial& material, const CornerArrays& corners,
                       const Ball& around) const {
  for (std::size_t first = 0; first < corners.count; first += LightBlock::kMost) {
    LightBlock block;
    block.count = std::min(LightBlock::kMost, corners.count - first);
    for (std::size_t k = 0; k < 3; ++k) {
      block.position[k] = corners.position[k] + first;
      block.normal[k] = corners.normal[k] + first;
    }
    begin_light(block, eye, ambient);
    LampReach reach;
    for (const Lamp& lamp : lamps) {
      if (!lamp.may_reach(around)) continue;  // it adds nothing to any
      const LampFactors by{lamp,
                           lamp.narrowing->values(),
                           material.shine->values(),
                           material.specular,
                           {lamp.place.x(), lamp.place.y(), lamp.place.z()},
                           {lamp.forward.x(), lamp.forward.y(), lamp.forward.z()}};
      lamp.is_spot ? reach_of_spot(block, by, reach) : reach_of_sun(block, by, reach);
      add_lamp(block, by, reach);
    }
    for (std::size_t k = 0; k < 3; ++k)
      end_light(block, k, share, material.emission[k], material.color[k], corners.color[k] + first);
  }
}

std::array<float, 3> LampsThere::color_of(const VertexMaterial& material, const Float3& position,
                                          const Float3& normal) const {
  std::array<float, 3> color{};
  CornerArrays one{.count = 1};
  for (std::size_t k = 0; k < 3; ++k) {
    one.position[k] = position.data() + k;
    one.normal[k] = normal.data() + k;
    one.color[k] = &color[k];
  }
  light(material, one, {position, 0});
  return color;
}

}  // namespace probe::render
