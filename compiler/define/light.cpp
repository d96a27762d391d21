// `light`: an ambient part and any number of suns.
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

}  // namespace

void define_lights(Context& context) {
  for (const auto& declared : context.symbols.light_decls) {
    Light light;
    light.name = std::string(declared.node->name.text);
    light.span = declared.node->name.span;
    for (const syntax::LightStmt& stmt : declared.node->body) {
      if (const auto* ambient = std::get_if<syntax::AmbientStmt>(&stmt)) {
        light.ambient = read_si(context, ambient->value, dim::kNumber,
                                {"`ambient` takes a number", plan::Magnitude::kLight})
                            .value_or(0);
        if (light.ambient < 0)
          context.report(Situation::kNegative, ambient->value.span,
                         "expected an ambient light of 0 or more");
        if (!ambient->occlusion) continue;
        if (ambient->occlusion->value < 1 || ambient->occlusion->value > plan::kMaxOcclusion) {
          context.report(Situation::kOcclusionRays, ambient->occlusion->span,
                         "expected 1 to 16 rays to find how open a place is");
          continue;
        }
        light.occlusion = static_cast<std::uint32_t>(ambient->occlusion->value);
        continue;
      }
      if (const auto* color = std::get_if<syntax::LightColorStmt>(&stmt)) {
        light.color = read_color(context, *color);
        continue;
      }
      const auto& written = std::get<syntax::SunStmt>(stmt);
      plan::SunRecord sun;
      assign(sun.direction, read_point(context, written.direction, 3, 3, dim::kNumber,
                                       "`sun` takes a direction of plain numbers"));
      if (sun.direction == std::array<double, 3>{}) {
        context.report(Situation::kNoDirection, written.direction.span,
                       "a sun shines along a direction, found none");
      } else {
        check_magnitude(context, written.direction.span,
                        std::hypot(sun.direction[0], sun.direction[1], sun.direction[2]),
                        plan::Magnitude::kDirection);
      }
      sun.power = read_positive(context, written.power, dim::kNumber,
                                {"`power` takes a number", plan::Magnitude::kLight})
                      .value_or(1);
      sun.shadow = written.shadow ? 1 : 0;
      light.suns.push_back(sun);
      if (light.suns.size() == plan::kMaxSuns + 1) {
        context.report(Situation::kTooManySuns, written.span,
                       "expected at most " + std::to_string(plan::kMaxSuns) + " suns in a light");
      }
    }
    context.model.lights.add(std::move(light));
  }
}

}  // namespace probe::sema
