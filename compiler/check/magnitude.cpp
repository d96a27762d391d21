// P0303: quantities that have the right dimension and a size that nobody means, such as a table of
// 16 m. One band a statement, wide enough for every desk and arm; an @allow keeps the exception.
#include <fmt/format.h>

#include <cmath>

#include "compiler/check/check.h"

namespace probe::sema {
namespace {

struct Band {
  double least = 0, most = 0;  // of the absolute value, SI
  const char* usual = "";
};

constexpr Band kSide{0.001, 1, "1mm to 1m"};
constexpr Band kMass{1e-4, 100, "0.0001kg to 100kg"};
constexpr Band kDensity{5, 150'000, "5kg/m3 to 150000kg/m3"};
constexpr Band kReach{0.02, 3, "2cm to 3m"};
constexpr Band kNear{0, 1, "at most 1m"};
constexpr Band kPlace{0, 2, "within 2m of the origin"};
constexpr Band kSpread{0, 1, "at most 1m"};
constexpr Band kHeight{0, 3, "at most 3m"};
constexpr Band kDrop{0, 1, "at most 1m"};
constexpr Band kSettle{0, 10, "at most 10s"};
constexpr Band kJitter{0, 0.2, "at most 20cm"};
constexpr Band kControl{0.1, 1000, "0.1Hz to 1000Hz"};
constexpr Band kPhysics{50, 20'000, "50Hz to 20000Hz"};
constexpr Band kGrip{0, 0.2, "at most 20cm"};
constexpr Band kFriction{0.01, 5, "0.01 to 5"};
constexpr Band kFocal{10, 20'000, "10px to 20000px"};
constexpr Band kTurn{0, 6.2832, "at most a full turn"};

struct Magnitudes {
  Reporter& reporter;

  void check(const syntax::Quantity& written, const Band& band, std::string_view what) {
    if (written.unit == syntax::Unit::kUnknown) return;
    const std::string digits = (written.negative ? "-" : "") + std::string(written.digits);
    const auto quantity = make_quantity(digits, to_text(written.unit));
    if (!quantity) return;
    const auto fits = [&](double value) {
      return std::abs(value) >= band.least && std::abs(value) <= band.most;
    };
    if (fits(quantity->si())) return;
    Diagnostic& slip = reporter.report(Code::P0303, written.span,
                                       "`" + digits + std::string(to_text(written.unit)) +
                                           "` is implausible for " + std::string(what));
    slip.point(std::string("usually ") + band.usual);
    // Water is 1 g/cm3 and 1000 kg/m3: the usual slip.
    if (quantity->dimension == dim::kDensity) {
      for (const double factor : {1e3, 1e-3}) {
        if (!fits(quantity->si() * factor)) continue;
        slip.help("did you mean `" + fmt::format("{:.6g}", quantity->si() * factor) + "kg/m3`?");
        return;
      }
    }
    for (const char* unit : {"cm", "mm", "m", "s", "ms", "deg", "rad"}) {
      const auto other = make_quantity(digits, unit);
      if (!other || !(other->dimension == quantity->dimension) || other->si() == quantity->si() ||
          !fits(other->si()))
        continue;
      slip.help("did you mean `" + digits + unit + "`?");
      return;
    }
  }
  // `90rad` is many turns, and `1.5708deg` a quarter turn in radians.
  void angle(const syntax::Quantity& written) {
    check(written, kTurn, "a turn");
    if (written.unit != syntax::Unit::kDegree) return;
    const auto degrees = make_quantity(written.digits, "rad");
    if (!degrees) return;
    constexpr double kEighth = 0.78539816339744831;
    const double eighths = degrees->si() / kEighth;
    const double nearest = std::round(eighths);
    if (nearest < 1 || nearest > 8 || std::abs(eighths - nearest) > 5e-3) return;
    const std::string digits = (written.negative ? "-" : "") + std::string(written.digits);
    reporter.report(Code::P0303, written.span, "`" + digits + "deg` is an implausible turn")
        .point("in radians it would be " + fmt::format("{:g}", nearest * 45) + "deg")
        .help("did you mean `" + digits + "rad`?");
  }
  void poses(const std::vector<syntax::Pose>& poses) {
    for (const syntax::Pose& pose : poses) {
      for (const syntax::Angle& turn : pose.angles) angle(turn.value);
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
  void operator()(const syntax::MassStmt& stmt) {
    check(stmt.value, kMass, "a mass");
    if (stmt.centre) point(*stmt.centre, kSpread, "a centre of mass");
  }
  void operator()(const syntax::FrictionStmt& stmt) { check(stmt.value, kFriction, "a friction"); }
  void operator()(const syntax::RestStmt& stmt) { poses(stmt.poses); }
  void operator()(const syntax::OrientStmt& stmt) { poses(stmt.poses); }
  void operator()(const syntax::PoseStmt& stmt) { poses(stmt.poses); }
  void operator()(const syntax::LensStmt& stmt) {
    for (const syntax::Quantity& value : stmt.values) check(value, kFocal, "a lens");
  }
  void operator()(const syntax::ReachStmt& stmt) {
    check(stmt.least, kNear, "the nearest reach of an arm");
    check(stmt.most, kReach, "the reach of an arm");
  }
  void operator()(const syntax::ControlStmt& stmt) { check(stmt.rate, kControl, "a control rate"); }
  void operator()(const syntax::GripStmt& stmt) {
    const auto open = make_quantity(stmt.open.digits, to_text(stmt.open.unit));
    // Fingers that turn have angles.
    if (open && open->dimension == dim::kAngle) return angle(stmt.open);
    check(stmt.open, kGrip, "a finger's way");
  }
  void operator()(const syntax::MountStmt& stmt) { point(stmt.at, kHeight, "a camera's place"); }
  void operator()(const syntax::SceneRobotStmt& stmt) {
    if (!stmt.at) return;
    point(*stmt.at, kHeight, "a robot's place");
    angle(stmt.yaw);
  }
  void operator()(const syntax::TaskSceneStmt& stmt) {
    for (const syntax::SceneStmt& one : stmt.body) std::visit(*this, one);
  }
  void operator()(const syntax::SurfaceStmt& stmt) {
    check(stmt.height, kHeight, "the height of a surface");
    point(stmt.low, kPlace, "a corner of a surface");
    point(stmt.high, kPlace, "a corner of a surface");
  }
  void operator()(const syntax::PhysicsStmt& stmt) {
    check(stmt.rate, kPhysics, "a physics rate");
    check(stmt.friction, kFriction, "a friction");
  }
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

void check_magnitudes(const Symbols& symbols, Reporter& reporter) {
  if (reporter.has_errors()) return;  // a wrong dimension has no size
  Magnitudes check{reporter};
  check.all(symbols.object_decls);
  check.all(symbols.robot_decls);
  check.all(symbols.camera_decls);
  check.all(symbols.scene_decls);
  check.all(symbols.layout_decls);
  for (const DeclaredTask& task : symbols.task_decls) {
    // The statements of a `derive` are those of all its tasks.
    if (task.derived) continue;
    for (const auto& stmt : *task.body) std::visit(check, stmt);
  }
  for (const auto& derive : symbols.derive_decls) {
    for (const auto& stmt : derive.node->body) std::visit(check, stmt);
  }
}

}  // namespace probe::sema
