#include "compiler/define/paint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "compiler/names/quantities.h"
#include "compiler/names/texts.h"

namespace probe::sema {
namespace {

struct NamedPaint {
  std::string_view name;
  std::array<std::uint8_t, 3> rgb;
};
constexpr NamedPaint kPaints[] = {
#define PROBE_PAINT(name, red, green, blue) {#name, {red, green, blue}},
#include "compiler/define/paints.def"
};

const NamedPaint* find_paint(std::string_view name) {
  const auto* const found = std::ranges::find(kPaints, name, &NamedPaint::name);
  return found == std::end(kPaints) ? nullptr : found;
}

// How unlike two colours look: the weighted distance of Riemersma's "redmean", 0 to 765.
double unlikeness(const std::array<std::uint8_t, 3>& a, const std::array<std::uint8_t, 3>& b) {
  const double red = (a[0] + b[0]) / 2.0;
  const double r = a[0] - b[0], g = a[1] - b[1], blue = a[2] - b[2];
  return std::sqrt((2 + red / 256) * r * r + 4 * g * g + (2 + (255 - red) / 256) * blue * blue);
}

// Room for what people call alike: red and a darker red.
constexpr double kRoom = 60;

}  // namespace

bool are_alike(const Paint& a, const Paint& b) { return unlikeness(a.rgb, b.rgb) <= kRoom; }

std::optional<AttributeId> color_attribute(const Model& model) {
  for (std::size_t i = 0; i < model.attributes.size(); ++i) {
    if (model.attributes[model.attributes.id(i)].name == "color") return model.attributes.id(i);
  }
  return std::nullopt;
}

std::optional<Paint> read_paint(Context& context, const syntax::PaintStmt& stmt) {
  if (const auto* name = std::get_if<syntax::Name>(&stmt.color)) {
    if (const NamedPaint* paint = find_paint(name->text)) return Paint{paint->rgb, name->span};
    std::vector<std::string_view> names;
    for (const NamedPaint& paint : kPaints) names.push_back(paint.name);
    report_unknown(context.diagnostics, "paint", *name, names)
        .help("any other colour is three numbers: `paint (0.9, 0.4, 0.1)`");
    return std::nullopt;
  }
  const auto& point = std::get<syntax::Point>(stmt.color);
  const auto shares =
      read_point(context, point, 3, 3, dim::kNumber, "`paint` takes shares of red, green and blue");
  if (!shares) return std::nullopt;
  Paint paint{{}, point.span};
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = (*shares)[i].si();
    if (!(share >= 0 && share <= 1)) {
      context.report(Situation::kColorRange, point.span,
                     "expected shares of red, green and blue between 0 and 1");
      return std::nullopt;
    }
    paint.rgb[i] = static_cast<std::uint8_t>(std::lround(255 * share));
  }
  return paint;
}

void check_paint(Context& context, const Object& object) {
  if (!object.paint) return;
  const auto attribute = color_attribute(context.model);
  if (!attribute) return;
  const auto& said = object.values[static_cast<std::size_t>(*attribute)];
  const auto& words = context.model.attributes[*attribute].values;
  if (said.empty()) return;
  const auto away = [&](const NamedPaint& paint) {
    return unlikeness(paint.rgb, object.paint->rgb);
  };
  double best_said = std::numeric_limits<double>::infinity();
  std::string listed;
  for (const std::uint32_t value : said) {
    const NamedPaint* paint = find_paint(words[value]);
    if (paint == nullptr) return;
    best_said = std::min(best_said, away(*paint));
    listed += (listed.empty() ? "" : ", ") + words[value];
  }
  // The nearest colour that can be said in this text.
  const NamedPaint* nearest = nullptr;
  for (const std::string& word : words) {
    const NamedPaint* paint = find_paint(word);
    if (paint != nullptr && (nearest == nullptr || away(*paint) < away(*nearest))) nearest = paint;
  }
  constexpr double kFactor = 1.5;
  if (nearest == nullptr || best_said <= kFactor * away(*nearest) + kRoom) return;
  context
      .report(Code::P1510, object.paint->span,
              "`" + object.name + "` is said to be " + listed + ", its paint is " +
                  std::string(nearest->name))
      .help("say what is seen: `color " + std::string(nearest->name) + "`");
}

std::optional<Cover> read_cover(Context& context, const syntax::TextureStmt& stmt, double side) {
  Cover cover{spelled(stmt.picture), side};
  if (stmt.side) {
    const auto read = read_positive(context, *stmt.side, dim::kLength,
                                    {"`texture` takes a length", plan::Magnitude::kExtent});
    if (!read) return std::nullopt;
    cover.side = *read;
  }
  return cover;
}

}  // namespace probe::sema
