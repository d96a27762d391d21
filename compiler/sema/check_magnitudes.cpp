// P0303: quantities that have the right dimension and a size that nobody means, such as a table of
// 16 m. One band a statement, wide enough for every desk and arm; an @allow keeps the exception.
#include <cmath>

#include "compiler/sema/passes.h"

namespace probe::sema {
namespace {

struct Band {
  double least = 0, most = 0;  // of the absolute value, SI
  const char* usual = "";
};

constexpr Band kSide{0.001, 1, "1mm to 1m"};
constexpr Band kDensity{1, 150'000, "1kg/m3 to 150000kg/m3"};
constexpr Band kReach{0.02, 3, "2cm to 3m"};
constexpr Band kPlace{0, 2, "within 2m of the origin"};
constexpr Band kSpread{0, 1, "at most 1m"};
constexpr Band kHeight{0, 3, "at most 3m"};
constexpr Band kDrop{0, 1, "at most 1m"};
constexpr Band kSettle{0, 10, "at most 10s"};
constexpr Band kJitter{0, 0.2, "at most 20cm"};
constexpr Band kControl{0.1, 1000, "0.1Hz to 1000Hz"};
constexpr Band kPhysics{50, 20'000, "50Hz to 20000Hz"};
constexpr Band kGrip{0, 0.2, "at most 20cm"};

struct Magnitudes {
  Context& context;

  void check(const syntax::Quantity& written, const Band& band, std::string_view what) {
    if (written.unit == syntax::Unit::kUnknown || written.unit == syntax::Unit::kNone) return;
    const std::string digits = (written.negative ? "-" : "") + std::string(written.digits);
    const auto quantity = make_quantity(digits, to_text(written.unit));
    if (!quantity) return;
    const auto fits = [&](double value) {
      return std::abs(value) >= band.least && std::abs(value) <= band.most;
    };
    if (fits(quantity->si())) return;
    Diagnostic& slip = context.report(Code::P0303, written.span,
                                      "`" + digits + std::string(to_text(written.unit)) +
                                          "` is implausible for " + std::string(what));
    slip.point(std::string("usually ") + band.usual);
    if (quantity->dimension != dim::kLength) return;
    for (const char* unit : {"cm", "mm", "m"}) {
      const auto other = make_quantity(digits, unit);
      if (!other || other->si() == quantity->si() || !fits(other->si())) continue;
      slip.help("did you mean `" + digits + unit + "`?");
      return;
    }
  }
  void point(const syntax::Point& written, const Band& band, std::string_view what) {
    for (const syntax::Quantity& value : written.coordinates) check(value, band, what);
  }

  void operator()(const syntax::BoxSizeStmt& stmt) {
    for (const syntax::Quantity* side : {&stmt.x, &stmt.y, &stmt.z})
      check(*side, kSide, "a side of a box");
  }
  void operator()(const syntax::BoxCornersStmt& stmt) {
    point(stmt.low, kSpread, "a corner of a box");
    point(stmt.high, kSpread, "a corner of a box");
  }
  void operator()(const syntax::DensityStmt& stmt) { check(stmt.value, kDensity, "a density"); }
  void operator()(const syntax::ReachStmt& stmt) {
    check(stmt.most, kReach, "the reach of an arm");
  }
  void operator()(const syntax::ControlStmt& stmt) { check(stmt.rate, kControl, "a control rate"); }
  void operator()(const syntax::GripStmt& stmt) { check(stmt.open, kGrip, "a finger's way"); }
  void operator()(const syntax::MountStmt& stmt) { point(stmt.at, kHeight, "a camera's place"); }
  void operator()(const syntax::SceneRobotStmt& stmt) {
    point(stmt.at, kHeight, "a robot's place");
  }
  void operator()(const syntax::SurfaceStmt& stmt) {
    check(stmt.height, kHeight, "the height of a surface");
    point(stmt.low, kPlace, "a corner of a surface");
    point(stmt.high, kPlace, "a corner of a surface");
  }
  void operator()(const syntax::PhysicsStmt& stmt) { check(stmt.rate, kPhysics, "a physics rate"); }
  void operator()(const syntax::CellsStmt& stmt) {
    point(stmt.at, kPlace, "the middle of a grid");
    for (const syntax::Point& spread : stmt.spreads) point(spread, kSpread, "a grid's spread");
  }
  void operator()(const syntax::PlaceAtStmt& stmt) { point(stmt.at, kPlace, "a place"); }
  void operator()(const syntax::JitterStmt& stmt) { check(stmt.value, kJitter, "a jitter"); }
  void operator()(const syntax::DropStmt& stmt) {
    check(stmt.height, kDrop, "a drop");
    if (stmt.settle) check(*stmt.settle, kSettle, "a settling time");
  }
  template <typename Other>
  void operator()(const Other&) {}

  template <typename Decls>
  void all(const Decls& decls) {
    for (const auto& declared : decls) {
      for (const auto& stmt : declared.node->body) std::visit(*this, stmt);
    }
  }
};

}  // namespace

void check_magnitudes(Context& context) {
  if (context.diagnostics.has_errors()) return;  // a wrong dimension has no size
  Magnitudes check{context};
  check.all(context.symbols.object_decls);
  check.all(context.symbols.robot_decls);
  check.all(context.symbols.camera_decls);
  check.all(context.symbols.scene_decls);
  check.all(context.symbols.layout_decls);
}

}  // namespace probe::sema
