// P0505 as a warning: a part of a fixture that a task speaks of, outside the image of every camera
// that does not move, where the task begins.
#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/check/starts.h"
#include "compiler/define/fixture.h"
#include "compiler/define/views.h"

namespace probe::sema {
namespace {

class UnseenChecker {
 public:
  UnseenChecker(const Model& model, const AssetRoot& asset_root, Reporter& reporter)
      : model_(model), reporter_(reporter), travels_(model, asset_root) {}

  void check(const Task& task) {
    if (task.starts.empty()) return;
    std::vector<CameraId> cameras;
    for (const View& view : views_of(model_, task)) cameras.push_back(view.camera);
    for (const auto& [role, id] : task.things()) {
      const auto [at, is_new] = known_.try_emplace(
          {task.scene, cameras, joint_starts_of(model_, task, task.starts.front()), id}, Unseen{});
      if (is_new) at->second = outside(task, model_.objects[id]);
      if (at->second.out.pixels >= 1) report(task, role, id, at->second);
    }
  }

 private:
  struct Unseen {
    Lookout::Out out{0, nullptr};
    std::size_t cameras = 0;  // that stand still
  };

  // Of nothing where no camera stands still. The first start's cameras and joints tell, and of a
  // region the part that it belongs to.
  Unseen outside(const Task& task, const Object& thing) {
    const Scene& scene = model_.scenes[task.scene];
    const TaskStarts starts{model_, reporter_, task, model_.layouts[task.layout]};
    std::vector<scene::Solid> boxes;
    for (const BegunFixture& fixture : begun_fixtures(starts, travels_)) {
      if (&fixture.fixture != &model_.fixtures[thing.of->fixture]) continue;
      for (const PartBox& box : fixture.travel.at(fixture.joints.front())) {
        if (box.part == thing.of->part) boxes.push_back(box.solid);
      }
    }
    Lookout lookout;
    lookout.look(model_, scene, views_of(model_, task), 0);
    if (boxes.empty() || lookout.fixed() == 0) return {};
    return {lookout.outside(boxes), lookout.fixed()};
  }

  void report(const Task& task, RoleId role, ObjectId id, const Unseen& unseen) {
    const About about(reporter_, task.decl_span);
    const auto index = static_cast<std::size_t>(role);
    const Span& said_at = index < task.role_span.size() ? task.role_span[index] : task.span;
    const Camera& camera = *unseen.out.of;
    const Object& thing = model_.objects[id];
    const Fixture& fixture = model_.fixtures[thing.of->fixture];
    // A region has no shape that a camera could see.
    const std::string& part = fixture.parts[thing.of->part].name;
    const std::string seen =
        thing.of->is_part()
            ? "`" + thing.name + "`"
            : "`" + fixture.name + (part.empty() ? "" : "." + part) + "` with `" + thing.name + "`";
    Diagnostic& said = reporter_.report(
        Situation::kOutOfFrame, task.place(said_at.is_none() ? task.span : said_at),
        seen + ", of which `" + task.name + "` speaks, " + Lookout::where(unseen.out.pixels) +
            " `" + camera.name + "`" +
            (unseen.cameras > 1 ? ", and no other camera that stands still sees it" : ""));
    said.severity = Severity::kWarning;
    said.cause = cause_of(model_.scenes[task.scene].span, {camera.name, thing.name});
    said.label(camera.span, "the camera")
        .label(fixture.span, "the fixture")
        .help("move the fixture, or turn the camera: `vlaprobe preview F " + task.name +
              " -o seen.png` shows what it sees");
  }

  const Model& model_;
  Reporter& reporter_;
  Travels travels_;
  std::map<std::tuple<SceneId, std::vector<CameraId>, std::vector<double>, ObjectId>, Unseen>
      known_;
};

}  // namespace

void check_unseen(const Model& model, const AssetRoot& asset_root, Reporter& reporter) {
  UnseenChecker checker(model, asset_root, reporter);
  for (const Task& task : model.tasks) {
    if (!task.abstract && task.complete) checker.check(task);
  }
}

}  // namespace probe::sema
