// `camera`: where it is mounted, where it looks, what its picture is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/define/define.h"
#include "compiler/define/record.h"
#include "compiler/define/robot.h"
#include "compiler/names/quantities.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

struct CameraReader {
  Context& context;
  Camera& camera;

  void operator()(const syntax::MountStmt& stmt) {
    if (stmt.frame.parts.size() != 2) {
      context.report(Situation::kMountPath, stmt.frame.span,
                     "expected `robot.link` to mount the camera on");
    } else {
      const auto robot = context.symbols.robots.find(stmt.frame.parts[0], context.diagnostics);
      camera.mount_link = spelled(stmt.frame.parts[1]);
      if (robot) {
        camera.mount_robot = static_cast<RobotId>(*robot);
        check_link(context, camera.mount_link, context.model.robots[camera.mount_robot]);
      }
    }
    assign(camera.position, read_point(context, stmt.at, 3, 3, dim::kLength,
                                       {"`mount ... at` takes lengths", plan::Magnitude::kPlace}));
    const bool looks = stmt.kind == syntax::MountKind::kLook;
    camera.aim = looks ? plan::CameraAim::kLook : plan::CameraAim::kQuat;
    camera.aim_values = {};
    const std::size_t count = looks ? 3 : 4;
    const auto aim = read_point(
        context, stmt.direction, count, count, dim::kNumber,
        looks ? "`look` takes a direction of plain numbers" : "`quat` takes plain numbers");
    assign(camera.aim_values, aim);
    const auto& values = camera.aim_values;
    const auto is_zero = [](double value) { return value == 0; };
    if (aim && looks && std::all_of(values.begin(), values.end(), is_zero)) {
      context
          .report(Situation::kNoDirection, stmt.direction.span,
                  "a camera looks along a direction, found none")
          .help("a direction is a vector, such as `look (1, 0, -1)`");
    } else if (aim && looks && values[0] == 0 && values[1] == 0) {
      context
          .report(Situation::kVerticalView, stmt.direction.span,
                  "the view is vertical, which leaves its roll open")
          .help("give the orientation with `quat`");
    } else if (aim && looks) {
      check_magnitude(context, stmt.direction.span, std::hypot(values[0], values[1], values[2]),
                      plan::Magnitude::kDirection);
    }
    if (aim && !looks) make_unit(stmt.direction.span);
  }
  // A published quaternion has six digits or so; a plan wants its length to be 1.
  void make_unit(const Span& span) {
    double squares = 0;
    for (const double value : camera.aim_values) squares += value * value;
    const double length = std::sqrt(squares);
    if (std::abs(length - 1) > 1e-3) {
      context.report(Situation::kNotUnit, span,
                     "expected a unit quaternion (w, x, y, z), found one of another length");
      return;
    }
    for (double& value : camera.aim_values) value /= length;
  }
  void operator()(const syntax::ImageStmt& stmt) {
    camera.width = size(stmt.width);
    camera.height = size(stmt.height);
    camera.samples = 0;
    if (!stmt.samples) return;
    const auto samples = stmt.samples->value;
    if (samples != 1 && samples != 4 && samples != 16) {
      context.report(Situation::kSampleCount, stmt.samples->span,
                     "expected 1, 4 or 16 samples a pixel");
      return;
    }
    // The renderer traces a picture of all samples and averages it.
    const std::uint32_t across = samples == 16 ? 4 : samples == 4 ? 2 : 1;
    if (std::max(camera.width, camera.height) * across > plan::kMaxPixels) {
      context.report(Situation::kImageTooLarge, stmt.samples->span,
                     "with " + std::to_string(samples) +
                         " samples a pixel an image side is at most " +
                         std::to_string(plan::kMaxPixels / across) + " pixels");
      return;
    }
    if (samples > 1) camera.samples = static_cast<std::uint32_t>(samples);
  }
  void operator()(const syntax::LensStmt& stmt) {
    if (stmt.values.size() != 4) {
      context.report(Code::P0302, stmt.span,
                     "expected fx, fy, cx, cy, found " + std::to_string(stmt.values.size()) +
                         (stmt.values.size() == 1 ? " value" : " values"));
      return;
    }
    double* const to[] = {&camera.fx, &camera.fy, &camera.cx, &camera.cy};
    for (std::size_t i = 0; i < 4; ++i) {
      const plan::Magnitude magnitude = i < 2 ? plan::Magnitude::kFocal : plan::Magnitude::kPixel;
      *to[i] =
          read_positive(context, stmt.values[i], dim::kPixel, {"`lens` takes pixels", magnitude})
              .value_or(1);
    }
  }
  // What a copy had is replaced whole.
  void operator()(const syntax::SensorStmt& stmt) {
    plan::SensorRecord& sensor = camera.sensor = {};
    const auto share = [&](const std::optional<syntax::Quantity>& written, double most,
                           double& to) {
      if (!written) return;
      const auto value =
          read_si(context, *written, dim::kNumber, "noise, exposure and dropped are numbers");
      if (!value) return;
      if (!(*value >= 0 && *value <= most)) {
        context.report(Situation::kColorRange, written->span,
                       fmt::format("expected a number between 0 and {}", most));
        return;
      }
      to = *value;
    };
    share(stmt.noise, 1, sensor.noise);
    // What is less than that no policy sees: a level of a picture, a hundredth of a pixel.
    constexpr double kLevel = 1.0 / 255, kLeastBlur = 0.01;
    if (sensor.noise > 0 && sensor.noise < kLevel)
      context
          .report(
              Situation::kNoEffect, stmt.noise->span,
              "a noise of less than 1/255, which is 0.00392, is less than one level of a picture")
          .help("write `sensor none` for a camera without any");
    share(stmt.dropped, 1, sensor.dropped);
    sensor.mirrored = stmt.mirrored ? 1 : 0;
    share(stmt.exposure, plan::kMaxExposure, sensor.exposure);
    if (stmt.exposure && sensor.exposure == 0 && context.mistakes() == 0)
      context.report(Situation::kNotPositive, stmt.exposure->span,
                     "expected an exposure of more than 0");
    if (sensor.exposure == 1) sensor.exposure = 0;
    if (stmt.blur) {
      const auto blur = read_positive(context, *stmt.blur, dim::kPixel,
                                      {"`blur` takes pixels", plan::Magnitude::kPixel});
      if (blur && *blur > plan::kMaxBlur)
        context.report(Situation::kColorRange, stmt.blur->span,
                       fmt::format("expected a blur of at most {}px", plan::kMaxBlur));
      if (blur && *blur < kLeastBlur)
        context
            .report(
                Situation::kNoEffect, stmt.blur->span,
                fmt::format("a blur of less than {}px moves no light to another pixel", kLeastBlur))
            .help("write `sensor none` for a camera without any");
      sensor.blur = blur.value_or(0);
    }
    if (stmt.patch_low && stmt.patch_high) patch(*stmt.patch_low, *stmt.patch_high);
  }
  void operator()(const syntax::CameraJitterStmt& stmt) {
    camera.jitter_span = stmt.span;
    const auto read = [&](const syntax::Quantity& written, Dimension dimension, const char* takes,
                          plan::Magnitude magnitude) {
      const double most = read_si(context, written, dimension, {takes, magnitude}).value_or(0);
      if (most < 0)
        context.report(Situation::kNegative, written.span, "expected a jitter of 0 or more");
      return std::max(0.0, most);
    };
    camera.jitter_place =
        read(stmt.place, dim::kLength, "`jitter` of a camera takes a length and an angle",
             plan::Magnitude::kLength);
    camera.jitter_turn =
        read(stmt.turn, dim::kAngle, "`jitter` of a camera takes a length and an angle",
             plan::Magnitude::kJointPosition);
    constexpr double kMost = std::numbers::pi / 2;
    if (camera.jitter_turn <= kMost) return;
    context.report(Situation::kCameraTurn, stmt.turn.span,
                   "expected a turn of at most 90deg about each axis");
    camera.jitter_turn = 0;
  }
  void patch(const syntax::Point& low, const syntax::Point& high) {
    const char* takes = "a patch takes shares of the picture's width and height";
    const auto from = read_point(context, low, 2, 2, dim::kNumber, takes);
    const auto to = read_point(context, high, 2, 2, dim::kNumber, takes);
    if (!from || !to) return;
    const std::array<double, 4> edges = {(*from)[0].si(), (*from)[1].si(), (*to)[0].si(),
                                         (*to)[1].si()};
    for (const double edge : edges) {
      if (edge >= 0 && edge <= 1) continue;
      context.report(Situation::kColorRange, join(low.span, high.span),
                     "expected shares of the picture between 0 and 1, (0, 0) at the left top");
      return;
    }
    if (edges[0] < edges[2] && edges[1] < edges[3]) {
      camera.sensor.patch = edges;
      return;
    }
    context.report(Situation::kCornersSwapped, join(low.span, high.span),
                   "the second corner of a patch lies right of the first and below it");
  }
  std::uint32_t size(const syntax::Int& value) {
    if (value.value >= 1 && value.value <= plan::kMaxPixels)
      return static_cast<std::uint32_t>(value.value);
    context.report(
        Situation::kImageTooLarge, value.span,
        "expected an image side between 1 and " + std::to_string(plan::kMaxPixels) + " pixels");
    return 1;
  }
};

}  // namespace

void define_cameras(Context& context) {
  const auto read = [&](const Declared<syntax::CameraDecl>& declared, Camera& camera) {
    for (const syntax::CameraStmt& stmt : declared.node->body)
      std::visit(CameraReader{context, camera}, stmt);
  };
  const auto complete = [&](const Camera& camera, bool) {
    const auto need = [&](bool is_there, std::string_view statement) {
      require(context, is_there, "camera", camera.name, camera.span, statement);
    };
    need(!camera.mount_link.span.is_none(), "mount");
    need(camera.width != 0, "image");
    need(camera.fx != 0, "lens");
  };
  define_records(context, context.symbols.cameras, context.symbols.camera_decls,
                 context.model.cameras, read, complete);
}

}  // namespace probe::sema
