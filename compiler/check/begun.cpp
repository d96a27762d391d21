// P0607: success that is true before anything has moved, in starts of a task, what ends an episode
// and is, what is asked "was it ever so" and is so in all of them, and what brings the second
// sentence and is so in some. A policy that does nothing has them. What is not known before things
// settle, as whether one lies on another, says nothing here.
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "compiler/check/check.h"
#include "compiler/check/starts.h"
#include "compiler/define/fixture.h"
#include "compiler/define/in_start.h"
#include "compiler/define/views.h"
#include "compiler/geometry/centre.h"
#include "compiler/geometry/footprint.h"
#include "compiler/lower/lower.h"
#include "runtime/plan/readouts.h"

namespace probe::sema {
namespace {

constexpr double kApart = 0.005;        // m: what is farther from something does not touch it
constexpr double kJointSettles = 1e-3;  // m, rad
constexpr std::size_t kMostNamed = 12;  // starts that a message names

class BegunChecker {
 public:
  BegunChecker(const Model& model, const AssetRoot& asset_root, Reporter& reporter)
      : model_(model), centres_(asset_root), reporter_(reporter) {}

  void check(const Task& task) {
    check_later(task);
    if (task.starts.empty()) return;
    const std::vector<lower::Body> bodies = lower::bodies_of(model_, task);
    const Metric* ends = nullptr;
    bool is_begun = false;
    for (const Metric& metric : task.judged) {
      const bool is_success = metric.name == "success";
      if (metric.name == plan::kEndsMetric) ends = &metric;
      if (metric.type.kind != TypeKind::kBool || &metric == ends ||
          (!is_success && metric.readout != plan::Readout::kOnce))
        continue;
      is_begun = check(task, metric, is_success, bodies) || is_begun;
    }
    if (ends != nullptr && !is_begun) check(task, *ends, true, bodies);
  }

 private:
  // Of the sentence that comes first, as far as joints say, which begin elsewhere in starts of a
  // table alone: what brings another is waited for when joints have moved. Where it is so in all
  // starts the lowered program is told of, by P0602.
  void check_later(const Task& task) {
    if (task.later.empty() || model_.layouts[task.layout].given_joints.empty()) return;
    const Metric& when = task.later.front().when;
    const std::vector<lower::Body> bodies = lower::bodies_of(model_, task);
    const CameraId camera = views_of(model_, task).front().camera;
    const Frame frame = frame_of(model_, model_.scenes[task.scene], model_.cameras[camera]);
    Diagnostics unsaid;
    const auto program = lower::lower_metrics(model_, {&when, 1}, bodies, frame, unsaid);
    if (!program) return;
    std::vector<std::size_t> begun;
    for (std::size_t i = 0; i < task.starts.size(); ++i) {
      lower::AtRest rest{{}, {}, [](auto, auto) { return std::optional<bool>(); }};
      rest.joints = joints_at(task, task.starts[i]);
      if (lower::holds_at_rest(*program, 0, rest) == true) begun.push_back(i);
    }
    if (begun.empty() || begun.size() == task.starts.size()) return;
    if (!said_.insert({when.span, task.starts.data()}).second) return;
    const About about(reporter_, task.decl_span);
    report_of(reporter_, Code::P0607, task, task.place(when.span),
              "what brings the next sentence of `" + task.name +
                  "` holds before anything moves in " + in_words(begun, task.starts.size()))
        .point("the sentence before it is said in one step alone there")
        .help("begin otherwise in these starts, or ask for them in a task of their own");
  }

  std::vector<lower::Interval> joints_at(const Task& task, const Start& start) const {
    std::vector<lower::Interval> joints;
    for (const double joint : joint_starts_of(model_, task, start))
      joints.push_back({joint - kJointSettles, joint + kJointSettles});
    return joints;
  }

  // "2 of 24 starts: 3, 7"
  static std::string in_words(const std::vector<std::size_t>& begun, std::size_t of) {
    if (begun.size() == of)
      return of == 1 ? "its one start" : "all of its " + std::to_string(of) + " starts";
    std::string text = std::to_string(begun.size()) + " of " + std::to_string(of) + " starts: ";
    for (std::size_t i = 0; i < begun.size() && i < kMostNamed; ++i)
      text += (i == 0 ? "" : ", ") + std::to_string(begun[i]);
    return text + (begun.size() > kMostNamed ? " .." : "");
  }

  // Places are known of what falls from a layout's height and stays there: not of what moves by
  // itself, of what an episode begins with in the air, nor of what stands on something.
  bool are_places_known(const Task& task) const {
    const auto is_put = [](const Start::Placed& placed) { return placed.z.has_value(); };
    return task.motions.empty() && !model_.layouts[task.layout].begins_placed &&
           std::ranges::none_of(task.starts.front().placed, is_put);
  }

  // Whether it is success that was found to be so.
  bool check(const Task& task, const Metric& metric, bool is_success,
             const std::vector<lower::Body>& bodies) {
    const lower::Program* program = program_of(task, metric, bodies);
    if (program == nullptr) return false;
    std::vector<std::size_t> begun;
    for (std::size_t i = 0; i < task.starts.size(); ++i) {
      if (holds(*program, task, bodies, task.starts[i])) {
        begun.push_back(i);
      } else if (!is_success) {
        return false;  // it tells the one start from the other
      }
    }
    if (begun.empty()) return false;
    // What has to be so all along begins so.
    if (begun.size() == task.starts.size() && metric.readout == plan::Readout::kAlways)
      return false;
    if (said_.insert({metric.span, task.starts.data()}).second) report(task, metric, begun);
    return is_success;
  }

  // A metric as a program, made once for tasks of one shape; null where it is false wherever things
  // lie apart, or cannot be lowered, which is said elsewhere.
  const lower::Program* program_of(const Task& task, const Metric& success,
                                   const std::vector<lower::Body>& bodies) {
    const CameraId camera = views_of(model_, task).front().camera;
    std::vector<std::uint32_t> shape = lower::shape_of(model_, {&success, 1}, bodies);
    if (model_.exprs.needs_frame)
      shape.insert(shape.end(),
                   {static_cast<std::uint32_t>(task.scene), static_cast<std::uint32_t>(camera)});
    const auto [at, is_new] = programs_.try_emplace(std::move(shape));
    if (is_new) {
      Diagnostics unsaid;
      at->second = lower::lower_metrics(
          model_, {&success, 1}, bodies,
          frame_of(model_, model_.scenes[task.scene], model_.cameras[camera]), unsaid);
      const auto touch = [&](std::uint16_t a, std::uint16_t b) -> std::optional<bool> {
        return is_robot(bodies[a]) || is_robot(bodies[b]) ||
                       (is_object(bodies[a]) && is_object(bodies[b]))
                   ? std::optional(false)
                   : std::nullopt;
      };
      if (at->second && lower::holds_at_rest(*at->second, 0, {{}, {}, touch}) == false)
        at->second.reset();
    }
    return at->second ? &*at->second : nullptr;
  }

  static bool is_robot(const lower::Body& body) { return body.kind == plan::BodyKind::kLink; }
  static bool is_object(const lower::Body& body) { return body.kind == plan::BodyKind::kObject; }

  bool holds(const lower::Program& program, const Task& task,
             const std::vector<lower::Body>& bodies, const Start& start) {
    if (!are_places_known(task)) {
      const auto touch = [](auto, auto) { return std::optional<bool>(); };
      return lower::holds_at_rest(program, 0, {{}, joints_at(task, start), touch}) == true;
    }
    const Scene& scene = model_.scenes[task.scene];
    std::vector<Footprint> prints;
    for (const Start::Placed& placed : start.placed)
      prints.push_back(footprint(model_.objects[placed.object], placed));
    const auto is_apart = [&](std::size_t a, std::size_t b) {
      return overlap(prints[a], prints[b]) < -kApart;
    };
    const auto touch = [&](std::uint16_t a, std::uint16_t b) -> std::optional<bool> {
      if (is_robot(bodies[a]) || is_robot(bodies[b])) return false;
      if (is_object(bodies[a]) && is_object(bodies[b]))
        return is_apart(a, b) ? std::optional(false) : std::nullopt;
      const std::uint16_t object = is_object(bodies[a]) ? a : b;
      const std::uint16_t other = object == a ? b : a;
      // On the bare surface, alone.
      if (!is_object(bodies[object]) || bodies[other].kind != plan::BodyKind::kSurface ||
          scene.fixture || !scene.fixtures.empty())
        return std::nullopt;
      for (std::size_t k = 0; k < prints.size(); ++k) {
        if (k != object && !is_apart(k, object)) return std::nullopt;
      }
      return true;
    };
    const lower::AtRest rest{placed_objects(model_, centres_, task, start), joints_at(task, start),
                             touch};
    return lower::holds_at_rest(program, 0, rest) == true;
  }

  void report(const Task& task, const Metric& metric, const std::vector<std::size_t>& begun) {
    const About about(reporter_, task.decl_span);
    const bool ends = metric.name == plan::kEndsMetric;
    const char* help =
        "it says nothing of a policy: begin otherwise, or ask for what has to change";
    if (ends) {
      help =
          "episodes are over after their first step there: begin otherwise, or ask for what has "
          "to change";
    } else if (metric.name == "success" && task.source == ObjectId::kNone) {
      help = "begin otherwise: a joint has its `start` in the task, its layout or its fixture";
    } else if (metric.name == "success") {
      help =
          "place things so that none begins so, or ask for what has to move as well: `.. and "
          "displaced(source)`";
    }
    report_of(reporter_, Code::P0607, task, task.span,
              "`" + std::string(ends ? "ends when" : metric.name) + "` of `" + task.name +
                  "` is true before anything moves in " + in_words(begun, task.starts.size()))
        .label(metric.span, "judged by this")
        .help(help);
  }

  const Model& model_;
  Centres centres_;
  Reporter& reporter_;
  std::map<std::vector<std::uint32_t>, std::optional<lower::Program>> programs_;
  std::set<std::pair<Span, const Start*>> said_;
};

}  // namespace

void check_begun(const Model& model, const AssetRoot& asset_root, Reporter& reporter) {
  if (reporter.has_errors()) return;  // what is lowered is whole
  BegunChecker checker(model, asset_root, reporter);
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    if (!model.robots[model.scenes[task.scene].robot].model) continue;
    checker.check(task);
  }
}

}  // namespace probe::sema
