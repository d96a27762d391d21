// P1512: starts of a task that are one start, down to the last bit: episodes of them measure the
// same thing again, and every count takes them for more than there is.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/check/starts.h"
#include "compiler/define/arm_start.h"
#include "compiler/define/fixture.h"
#include "compiler/define/remembered.h"
#include "compiler/define/role.h"
#include "compiler/define/task.h"
#include "compiler/define/views.h"

namespace probe::sema {
namespace {

// All that one start of a task may have other than another.
std::vector<double> numbers_of(const Model& model, const Task& task, std::size_t index) {
  const Start& start = task.starts[index];
  std::vector<double> all = joint_starts_of(model, task, start);
  const std::vector<double> arm = arm_start_of(model, task, index);
  all.insert(all.end(), arm.begin(), arm.end());
  for (const Start::Placed& placed : start.placed) {
    all.insert(all.end(), {placed.x, placed.y, placed.z.value_or(-1e9)});
    all.insert(all.end(), placed.turn.rotation.begin(), placed.turn.rotation.end());
  }
  return all;
}

// Of where things lie, which is most of it: equal starts have equal ones.
std::uint64_t hash_of(const Start& start) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a, by the number
  const auto add = [&](double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 1099511628211u;
    hash ^= hash >> 29;
  };
  for (const Start::Placed& placed : start.placed) {
    add(placed.x), add(placed.y);
    for (const double part : placed.turn.rotation) add(part);
  }
  return hash;
}

struct Repeated {
  std::size_t count = 0;          // starts that an earlier one equals
  std::size_t again = 0, of = 0;  // the first of them and what it equals
};

Repeated repeated_of(const Model& model, const Task& task) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  order.reserve(task.starts.size());
  for (std::size_t i = 0; i < task.starts.size(); ++i)
    order.emplace_back(hash_of(task.starts[i]), i);
  std::sort(order.begin(), order.end());
  Repeated found;
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && order[end].first == order[first].first) ++end;
    std::map<std::vector<double>, std::size_t> seen;  // the first start that is so
    for (std::size_t i = first; end - first > 1 && i < end; ++i) {
      const std::size_t at = order[i].second;
      const auto [earlier, is_new] = seen.try_emplace(numbers_of(model, task, at), at);
      if (is_new) continue;
      if (found.count++ == 0 || at < found.again) found.again = at, found.of = earlier->second;
    }
    first = end;
  }
  return found;
}

// "rest roll 90deg yaw 0deg, roll 90deg yaw 90deg": a turn, and on from there. Nothing where its
// angles are not clear.
std::optional<std::string> turns_text(const Turn& own, std::size_t count) {
  constexpr double kDegrees = 180 / 3.14159265358979323846, kUpright = 0.999;
  const auto& [w, x, y, z] = own.rotation;
  const double pitch_sine = 2 * (w * y - z * x);
  if (std::abs(pitch_sine) > kUpright) return std::nullopt;
  const auto degrees = [](double angle) { return std::round(angle * kDegrees * 100) / 100 + 0.0; };
  const double roll = degrees(std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)));
  const double pitch = degrees(std::asin(pitch_sine));
  const double yaw = degrees(std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)));
  std::string lying;
  if (roll != 0) lying += fmt::format("roll {:g}deg ", roll);
  if (pitch != 0) lying += fmt::format("pitch {:g}deg ", pitch);
  const std::size_t step = count <= 4 ? 90 : 360 / count;
  std::string text = "rest ";
  for (std::size_t i = 0; i < count; ++i)
    text += fmt::format("{}{}yaw {:g}deg", i == 0 ? "" : ", ", lying,
                        yaw + static_cast<double>(i * step));
  return text;
}

// Whether the layout says itself how an object is turned.
bool is_oriented(const Model& model, const Task& task, ObjectId id) {
  return std::ranges::any_of(model.layouts[task.layout].orients, [&](const Orient& orient) {
    if (const auto role = find_role(model, orient.what.text)) return task.role_of(id) == *role;
    if (model.objects[id].name == orient.what.text) return true;
    return orient.what.text == "distractors" &&
           std::ranges::find(task.distractors, id) != task.distractors.end();
  });
}

// Who has one turn where the layout goes through several.
struct Unturned {
  std::size_t turns = 1;  // of the layout
  std::optional<ObjectId> object;
  Unturned(const Model& model, const Task& task) {
    for (const ObjectId id : task.objects())
      turns = std::max(turns, rest_of(model, task, id).size());
    for (const ObjectId id : task.objects()) {
      if (!object && !is_oriented(model, task, id) && rest_of(model, task, id).size() == 1)
        object = id;
    }
    if (!model.layouts[task.layout].by_rest || turns == 1) object.reset();
  }
};

// What would make them differ.
void help(const Model& model, const Task& task, const Unturned& unturned, Diagnostic& said) {
  const Layout& layout = model.layouts[task.layout];
  if (!layout.given_span.is_none()) {
    said.help("leave the rows of one out of the file").cause = cause_of(layout.span, {layout.name});
    return;
  }
  if (!unturned.object) {
    said.help("give it other cells, or a `jitter`, which makes each start its own").cause =
        cause_of(layout.span, {layout.name});
    return;
  }
  const Object& object = model.objects[*unturned.object];
  const std::string turns = std::to_string(unturned.turns);
  const std::string one = "one turn, where others have " + turns;
  const auto pose = std::ranges::find(task.poses, *unturned.object, &PoseOverride::object);
  if (pose != task.poses.end()) {
    said.label(pose->span, one);
    said.help("give this `pose` " + turns + " turns that differ").cause =
        cause_of(pose->span, {object.name});
    return;
  }
  const auto text = turns_text(object.rest.front(), unturned.turns);
  said.label(object.span, one);
  said.help((text ? "write `" + *text + "`" : "write a `rest` of " + turns + " turns that differ") +
            " into `" + object.name + "`")
      .cause = cause_of(object.span, {object.name});
}

}  // namespace

void check_repeated(const Model& model, Reporter& reporter) {
  using Joints = std::vector<double>;
  // Tasks share lists of starts; which of them is told is for @allow and the causes to say.
  std::map<std::tuple<const Start*, SceneId, Joints>, Repeated> known;
  Silence silence(model, reporter, Silent::kRepeated);
  for (const Task& task : model.tasks) {
    if (task.starts.size() < 2 || silence.is_known(task)) continue;
    const Layout& layout = model.layouts[task.layout];
    // Those differ by the start's number.
    if (layout.jitter > 0 || layout.joints_jitter > 0) continue;
    const std::vector<View> views = views_of(model, task);
    if (std::ranges::any_of(views,
                            [&](const View& view) { return model.cameras[view.camera].jitters(); }))
      continue;
    const auto [at, is_new] = known.try_emplace(
        {task.starts.data(), task.scene, joint_starts_in_all(model, task)});
    if (is_new) at->second = repeated_of(model, task);
    const Repeated& repeated = at->second;
    if (repeated.count == 0) continue;
    const Unturned unturned(model, task);
    // Who writes the same turn twice knows; `audit` counts those starts.
    const bool is_written = unturned.turns > 1 || !layout.orients.empty();
    if (layout.given_span.is_none() && is_written && !unturned.object) continue;
    const About about(reporter, task.decl_span);
    const std::size_t all = task.starts.size();
    Diagnostic& said =
        report_of(reporter, Code::P1512, task, task.layout_span,
                  std::to_string(repeated.count) + " of the " + std::to_string(all) +
                      " starts of `" + task.name + "` " +
                      (repeated.count == 1 ? "repeats an earlier one" : "repeat an earlier one") +
                      ": it has " + std::to_string(all - repeated.count));
    said.point("start " + std::to_string(repeated.again) + " is start " +
               std::to_string(repeated.of));
    help(model, task, unturned, said);
  }
}

}  // namespace probe::sema
