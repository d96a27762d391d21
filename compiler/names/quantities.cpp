#include "compiler/names/quantities.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>

namespace probe::sema {

bool check_magnitude(Context& context, const Span& span, double value, plan::Magnitude magnitude) {
  const plan::MagnitudeInfo& known = plan::info(magnitude);
  if (known.fits(value)) return true;
  context.report(Situation::kMagnitude, span,
                 fmt::format("expected {} from {:g} to {:g}{}{}, found `{}`", known.what,
                             known.least, known.most, known.unit.empty() ? "" : " ", known.unit,
                             context.sources.text(span)));
  return false;
}

std::optional<Quantity> read_quantity(Context& context, const syntax::Quantity& written,
                                      const Dimension& wanted, const Takes& takes) {
  if (auto* wants = context.reporter.depth.wants)
    wants->push_back({written.span, wanted, std::string(takes.text)});
  if (written.unit == syntax::Unit::kUnknown) {
    ++context.unread;
    return std::nullopt;
  }
  const std::string digits = (written.negative ? "-" : "") + std::string(written.digits);
  const auto quantity = make_quantity(digits, to_text(written.unit));
  if (!quantity) {
    context
        .report(Situation::kTooManyDigits, written.span,
                "`" + digits + "` has more digits or a larger exponent than is kept")
        .help("18 digits, values below 1e14, steps down to 1e-18");
    return std::nullopt;
  }
  if (quantity->dimension == wanted) {
    const bool fits = !takes.magnitude ||
                      check_magnitude(context, written.span, quantity->si(), *takes.magnitude);
    return fits ? quantity : std::nullopt;
  }
  Diagnostic& diagnostic =
      context.report(Code::P0302, written.span,
                     "expected " + name_of(wanted) + ", found " + name_of(quantity->dimension));
  diagnostic.point(std::string(takes.text));
  // A layout's numbers are seen beside the first surface they may mean.
  if (quantity->dimension == dim::kNumber && takes.is_place && context.model.scenes.size() != 0 &&
      !context.model.scenes[static_cast<SceneId>(0)].broken) {
    const std::array<double, 4>& area = context.model.scenes[static_cast<SceneId>(0)].area;
    char depth[32];
    std::snprintf(depth, sizeof depth, "%.4gcm", (area[2] - area[0]) * 100);
    diagnostic.help("the surface is " + std::string(depth) + " deep: did you mean `" + digits +
                    "cm`?");
  } else if (quantity->dimension == dim::kNumber && !usual_unit(wanted).empty()) {
    diagnostic.help("a unit touches its number: `" + digits + std::string(usual_unit(wanted)) +
                    "`");
  }
  return std::nullopt;
}

std::optional<double> read_si(Context& context, const syntax::Quantity& written,
                              const Dimension& wanted, const Takes& takes) {
  const auto quantity = read_quantity(context, written, wanted, takes);
  if (!quantity) return std::nullopt;
  return quantity->si();
}

std::optional<double> read_positive(Context& context, const syntax::Quantity& written,
                                    const Dimension& wanted, const Takes& takes) {
  const auto value = read_si(context, written, wanted, takes);
  if (value && !(*value > 0)) {
    context
        .report(Situation::kNotPositive, written.span,
                "expected a value above zero, found `" +
                    std::string(context.sources.text(written.span)) + "`")
        .point(std::string(takes.text));
    return std::nullopt;
  }
  return value;
}

std::optional<std::vector<Quantity>> read_point(Context& context, const syntax::Point& point,
                                                std::size_t least, std::size_t most,
                                                const Dimension& wanted, const Takes& takes) {
  const std::size_t count = point.coordinates.size();
  if (count < least || count > most) {
    const std::string wants = least == most ? std::to_string(least)
                                            : std::to_string(least) + " or " + std::to_string(most);
    context
        .report(Code::P0302, point.span,
                "expected " + wants + " coordinates, found " + std::to_string(count))
        .point(std::string(takes.text));
    return std::nullopt;
  }
  std::vector<Quantity> values;
  for (const syntax::Quantity& coordinate : point.coordinates) {
    const auto value = read_quantity(context, coordinate, wanted, takes);
    if (value) values.push_back(*value);
  }
  if (values.size() != count) return std::nullopt;
  return values;
}

Turn make_turn(const Quantity* roll, const Quantity* pitch, const Quantity* yaw) {
  const SinCos none{0, 1};
  const SinCos x = roll ? roll->sincos_half() : none;
  const SinCos y = pitch ? pitch->sincos_half() : none;
  const SinCos z = yaw ? yaw->sincos_half() : none;
  // Extrinsic x, then y, then z: q = qz qy qx. Adding 0.0 turns -0.0 into 0.0, so that equal turns
  // have equal bytes.
  return {{z.cos * y.cos * x.cos + z.sin * y.sin * x.sin + 0.0,
           z.cos * y.cos * x.sin - z.sin * y.sin * x.cos + 0.0,
           z.cos * y.sin * x.cos + z.sin * y.cos * x.sin + 0.0,
           z.sin * y.cos * x.cos - z.cos * y.sin * x.sin + 0.0}};
}

std::optional<Turn> read_turn(Context& context, const syntax::Pose& pose) {
  std::array<std::optional<Quantity>, 3> turns;
  for (const syntax::Angle& angle : pose.angles) {
    auto& slot = turns[static_cast<std::size_t>(angle.turn)];
    const auto value = read_quantity(context, angle.value, dim::kAngle, "a turn is an angle");
    if (!value) return std::nullopt;
    if (slot) {
      context.report(Code::P0203, angle.span, "a pose turns about each axis once");
      return std::nullopt;
    }
    slot = value;
  }
  const auto pointer = [](const std::optional<Quantity>& value) {
    return value ? &*value : nullptr;
  };
  return make_turn(pointer(turns[0]), pointer(turns[1]), pointer(turns[2]));
}

std::optional<std::vector<Turn>> read_turns(Context& context,
                                            const std::vector<syntax::Pose>& poses) {
  std::vector<Turn> turns;
  for (const syntax::Pose& pose : poses) {
    if (const auto turn = read_turn(context, pose)) turns.push_back(*turn);
  }
  if (turns.size() != poses.size()) return std::nullopt;
  return turns;
}

}  // namespace probe::sema
