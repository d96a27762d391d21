#include "runtime/render/vertex_law.h"

#include <algorithm>
#include <cmath>

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

std::array<float, 3> LampsThere::color_of(const VertexMaterial& material, const Float3& position,
                                          const Float3& normal) const {
  std::array<float, 3> light = ambient, gloss{};
  const Float3 view = (eye - position).normalized();
  for (const Lamp& lamp : lamps) {
    Float3 toward = lamp.place;
    float reach = 1;
    if (lamp.is_spot) {
      toward -= position;
      const float distance = toward.norm();
      toward /= distance > 0 ? distance : 1;
      const float along = -toward.dot(lamp.forward);
      if (along < lamp.cutoff_cosine) continue;
      reach = lamp.narrowing->at(std::clamp(along, 0.0f, 1.0f));
      reach /= lamp.fade[0] + distance * (lamp.fade[1] + distance * lamp.fade[2]);
    }
    const float facing = normal.dot(toward);
    for (std::size_t k = 0; k < 3; ++k) light[k] += reach * lamp.ambient[k];
    if (!(facing > 0)) continue;
    const Float3 half = (toward + view).normalized();
    const float shine =
        reach * material.specular * material.shine->at(std::clamp(normal.dot(half), 0.0f, 1.0f));
    for (std::size_t k = 0; k < 3; ++k) {
      light[k] += reach * lamp.diffuse[k] * facing;
      gloss[k] += shine * lamp.specular[k];
    }
  }
  std::array<float, 3> color{};
  for (std::size_t k = 0; k < 3; ++k)
    color[k] = std::clamp(share * (material.emission[k] + light[k] * material.color[k]) + gloss[k],
                          0.0f, 1.0f);
  return color;
}

}  // namespace probe::render
