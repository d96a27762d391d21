// `light`: an ambient part and any number of suns, or lamps that light corners of triangles.
#include <algorithm>
#include <cmath>

#include "compiler/define/define.h"
#include "compiler/define/record.h"
#include "compiler/names/quantities.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

// Zeros for white, which is what a light is that says nothing.
std::array<double, 3> read_color(Context& context, const syntax::LightColorStmt& stmt) {
  const auto read =
      read_point(context, stmt.color, 3, 3, dim::kNumber,
                 {"`color` takes factors of red, green and blue", plan::Magnitude::kLight});
  if (!read) return {};
  std::array<double, 3> color{};
  for (std::size_t i = 0; i < 3; ++i) color[i] = (*read)[i].si();
  if (std::ranges::any_of(color, [](double channel) { return channel < 0; })) {
    context.report(Situation::kNegative, stmt.color.span, "expected factors of 0 or more");
  } else if (color == std::array<double, 3>{}) {
    context.report(Situation::kColorRange, stmt.color.span,
                   "expected some light of red, green or blue, found none");
  }
  return color == std::array<double, 3>{1, 1, 1} ? std::array<double, 3>{} : color;
}

std::array<double, 3> read_direction(Context& context, const syntax::Point& point,
                                     const char* takes, const char* shines) {
  std::array<double, 3> direction{};
  assign(direction, read_point(context, point, 3, 3, dim::kNumber, takes));
  if (direction == std::array<double, 3>{}) {
    context.report(Situation::kNoDirection, point.span, shines);
  } else {
    check_magnitude(context, point.span, std::hypot(direction[0], direction[1], direction[2]),
                    plan::Magnitude::kDirection);
  }
  return direction;
}

void read_ambient(Context& context, const syntax::AmbientStmt& ambient, Light& light) {
  light.ambient = read_si(context, ambient.value, dim::kNumber,
                          {"`ambient` takes a number", plan::Magnitude::kLight})
                      .value_or(0);
  if (light.ambient < 0)
    context.report(Situation::kNegative, ambient.value.span,
                   "expected an ambient light of 0 or more");
  if (!ambient.occlusion) return;
  if (ambient.occlusion->value < 1 || ambient.occlusion->value > plan::kMaxOcclusion) {
    context.report(Situation::kOcclusionRays, ambient.occlusion->span,
                   "expected 1 to 16 rays to find how open a place is");
    return;
  }
  light.occlusion = static_cast<std::uint32_t>(ambient.occlusion->value);
}

// 0 where it is not said; P0304 below that.
double read_strength(Context& context, const std::optional<syntax::Quantity>& written,
                     const Takes& takes) {
  if (!written) return 0;
  const double value = read_si(context, *written, dim::kNumber, takes).value_or(0);
  if (value < 0)
    context.report(Situation::kNegative, written->span, "expected a strength of 0 or more");
  return std::max(value, 0.0);
}

plan::LampRecord read_lamp(Context& context, const syntax::LampStmt& written) {
  plan::LampRecord lamp;
  lamp.kind = static_cast<std::uint32_t>(written.place ? plan::LampKind::kSpot
                                                       : plan::LampKind::kHeadlight);
  if (written.place)
    assign(lamp.position, read_point(context, *written.place, 3, 3, dim::kLength,
                                     {"`spot` stands at a place", plan::Magnitude::kPlace}));
  if (written.direction)
    lamp.direction =
        read_direction(context, *written.direction, "`along` takes a direction of plain numbers",
                       "a spot shines along a direction, found none");
  lamp.power =
      read_strength(context, written.power, {"`power` takes a number", plan::Magnitude::kLight});
  lamp.specular = read_strength(context, written.specular,
                                {"`specular` takes a number", plan::Magnitude::kLight});
  lamp.ambient = read_strength(context, written.ambient,
                               {"`ambient` takes a number", plan::Magnitude::kLight});
  constexpr double kQuarter = 1.5707963267948966;
  if (written.cutoff) {
    lamp.cutoff = read_positive(context, *written.cutoff, dim::kAngle, {"`cutoff` takes an angle"})
                      .value_or(0);
    if (lamp.cutoff > kQuarter)
      context.report(Situation::kCutoff, written.cutoff->span,
                     "expected a spot that ends within 90deg of its direction");
  }
  if (written.exponent) {
    lamp.exponent = read_si(context, *written.exponent, dim::kNumber, {"`exponent` takes a number"})
                        .value_or(0);
    constexpr double kMost = 128;  // OpenGL's
    if (!(lamp.exponent >= 0 && lamp.exponent <= kMost))
      context.report(Situation::kSpotExponent, written.exponent->span,
                     "expected an exponent of 0 to 128");
  }
  if (written.fade) {
    assign(lamp.fade, read_point(context, *written.fade, 3, 3, dim::kNumber,
                                 {"`fade` takes three plain numbers", plan::Magnitude::kLight}));
    if (std::ranges::any_of(lamp.fade, [](double factor) { return factor < 0; }) ||
        lamp.fade == std::array<double, 3>{})
      context.report(Situation::kNegative, written.fade->span,
                     "expected factors of 0 or more, of which one is more");
    if (lamp.fade == std::array<double, 3>{1, 0, 0}) lamp.fade = {};
  }
  return lamp;
}

}  // namespace

void define_lights(Context& context) {
  for (const auto& declared : context.symbols.light_decls) {
    Light light;
    light.name = std::string(declared.node->name.text);
    light.span = declared.node->name.span;
    light.lights_vertices =
        std::ranges::any_of(declared.node->body, [](const syntax::LightStmt& stmt) {
          return std::holds_alternative<syntax::ShadingStmt>(stmt);
        });
    const auto only = [&](bool vertices, const Span& span, const std::string& what) {
      if (light.lights_vertices == vertices) return;
      context.report(Situation::kShading, span,
                     vertices ? what + " lights corners of triangles: say `shading vertex`, too"
                              : "`shading vertex` has no " + what);
    };
    for (const syntax::LightStmt& stmt : declared.node->body) {
      if (const auto* ambient = std::get_if<syntax::AmbientStmt>(&stmt)) {
        read_ambient(context, *ambient, light);
        if (ambient->occlusion) only(false, ambient->occlusion->span, "occlusion");
        continue;
      }
      if (const auto* color = std::get_if<syntax::LightColorStmt>(&stmt)) {
        light.color = read_color(context, *color);
        continue;
      }
      if (const auto* lamp = std::get_if<syntax::LampStmt>(&stmt)) {
        only(true, lamp->span, lamp->place ? "a spot" : "a headlight");
        light.lamps.push_back(read_lamp(context, *lamp));
      }
      if (const auto* written = std::get_if<syntax::SunStmt>(&stmt)) {
        plan::SunRecord sun;
        sun.direction =
            read_direction(context, written->direction, "`sun` takes a direction of plain numbers",
                           "a sun shines along a direction, found none");
        sun.power = read_positive(context, written->power, dim::kNumber,
                                  {"`power` takes a number", plan::Magnitude::kLight})
                        .value_or(1);
        sun.shadow = written->shadow ? 1 : 0;
        if (written->shadow) only(false, written->span, "shadows");
        if (written->specular) only(true, written->specular->span, "`specular`");
        if (light.lights_vertices) {
          plan::LampRecord lamp;
          lamp.kind = static_cast<std::uint32_t>(plan::LampKind::kSun);
          lamp.direction = sun.direction;
          lamp.power = sun.power;
          lamp.specular = read_strength(context, written->specular,
                                        {"`specular` takes a number", plan::Magnitude::kLight});
          light.lamps.push_back(lamp);
        } else {
          light.suns.push_back(sun);
        }
      }
      if (std::max(light.suns.size(), light.lamps.size()) == plan::kMaxSuns + 1) {
        context.report(Situation::kTooManySuns,
                       std::visit([](const auto& of) { return of.span; }, stmt),
                       "expected at most " + std::to_string(plan::kMaxSuns) + " suns in a light");
        break;
      }
    }
    if (!light.lights_vertices) light.lamps.clear();
    context.model.lights.add(std::move(light));
  }
}

}  // namespace probe::sema
