#include "runtime/render/vertex_law.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/clones.h"

namespace probe::render {
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
  const float *px = block.position[0], *py = block.position[1], *pz = block.position[2];
  const float ex = eye.x(), ey = eye.y(), ez = eye.z();
  for (std::size_t i = 0; i < block.count; ++i) {
    const float x = ex - px[i], y = ey - py[i], z = ez - pz[i];
    const float square = x * x + (y * y + z * z);
    const float length = square > 0 ? std::sqrt(square) : 1;
    block.view[0][i] = x / length;
    block.view[1][i] = y / length;
    block.view[2][i] = z / length;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < block.count; ++i) {
      block.light[k][i] = ambient[k];
      block.gloss[k][i] = 0;
    }
  }
}

struct LampFactors {
  const LampsThere::Lamp& lamp;
  const float* narrowing;
  const float* shine;
  float specular;  // of the material
  std::array<float, 3> place, forward;
};

// Corner i, lit from (x, y, z), unit, by what reaches it of the lamp.
template <typename Reach>
[[gnu::always_inline]] inline void add_lamp(LightBlock& block, const LampFactors& by,
                                            const Reach& reach_of) {
  const float *nx = block.normal[0], *ny = block.normal[1], *nz = block.normal[2];
  const std::array<float, 3> ambient = by.lamp.ambient, diffuse = by.lamp.diffuse,
                             specular = by.lamp.specular;
  const float* const shine = by.shine;
  const float of_material = by.specular;
  PROBE_INDEPENDENT
  for (std::size_t i = 0; i < block.count; ++i) {
    float x = by.place[0], y = by.place[1], z = by.place[2];
    // Nothing reaches what lies beside a spot: zeros are added, which change no light.
    const float reach = reach_of(i, x, y, z);
    const float facing = nx[i] * x + (ny[i] * y + nz[i] * z);
    const bool is_lit = facing > 0;
    const float hx = x + block.view[0][i], hy = y + block.view[1][i], hz = z + block.view[2][i];
    const float square = hx * hx + (hy * hy + hz * hz);
    const float length = square > 0 ? std::sqrt(square) : 1;
    const float along = nx[i] * (hx / length) + (ny[i] * (hy / length) + nz[i] * (hz / length));
    const float power =
        PowerTable::read(shine, along < 0.0f ? 0.0f : (1.0f < along ? 1.0f : along));
    const float bright = is_lit ? reach * of_material * power : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const float with_ambient = block.light[k][i] + reach * ambient[k];
      const float straight = reach * diffuse[k] * facing;
      block.light[k][i] = with_ambient + (is_lit ? straight : 0);
      block.gloss[k][i] += bright * specular[k];
    }
  }
}

PROBE_CLONES void add_sun(LightBlock& block, const LampFactors& by) {
  add_lamp(block, by, [](std::size_t, float, float, float) { return 1.0f; });
}

PROBE_CLONES void add_spot(LightBlock& block, const LampFactors& by) {
  const float *px = block.position[0], *py = block.position[1], *pz = block.position[2];
  const std::array<float, 3> forward = by.forward, fade = by.lamp.fade;
  const float cutoff = by.lamp.cutoff_cosine;
  const float* const narrowing = by.narrowing;
  add_lamp(block, by, [=](std::size_t i, float& x, float& y, float& z) {
    x -= px[i];
    y -= py[i];
    z -= pz[i];
    const float distance = std::sqrt(x * x + (y * y + z * z));
    const float by_distance = distance > 0 ? distance : 1;
    x /= by_distance;
    y /= by_distance;
    z /= by_distance;
    const float along = -(x * forward[0] + (y * forward[1] + z * forward[2]));
    const float narrow =
        PowerTable::read(narrowing, along < 0.0f ? 0.0f : (1.0f < along ? 1.0f : along));
    const float reach = narrow / (fade[0] + distance * (fade[1] + distance * fade[2]));
    return along < cutoff ? 0 : reach;
  });
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
    for (const Lamp& lamp : lamps) {
      if (!lamp.may_reach(around)) continue;  // it adds nothing to any
      const LampFactors by{lamp,
                           lamp.narrowing->values(),
                           material.shine->values(),
                           material.specular,
                           {lamp.place.x(), lamp.place.y(), lamp.place.z()},
                           {lamp.forward.x(), lamp.forward.y(), lamp.forward.z()}};
      lamp.is_spot ? add_spot(block, by) : add_sun(block, by);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      float* color = corners.color[k] + first;
      for (std::size_t i = 0; i < block.count; ++i)
        color[i] =
            std::clamp(share * (material.emission[k] + block.light[k][i] * material.color[k]) +
                           block.gloss[k][i],
                       0.0f, 1.0f);
    }
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
