// P1202 of parts: "open the middle drawer" of what is judged by the top one.
#include <algorithm>
#include <set>
#include <string>

#include "compiler/check/check.h"
#include "compiler/check/other_said.h"
#include "compiler/define/wording.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

// What the task does with parts: what fills its roles, what success measures, what its solution
// handles on the way.
std::set<PartOf> parts_meant(const Model& model, const Task& task, Shared& shared) {
  std::set<PartOf> meant;
  for (const auto& [role, id] : task.things())
    meant.insert({model.objects[id].of->fixture, model.objects[id].of->part});
  const std::set<PartOf>& measured = shared.parts(Shared::success_of(task));
  meant.insert(measured.begin(), measured.end());
  if (meant.empty()) return meant;
  for (const SkillUse& skill : task.solution) {
    for (const SkillOperand& operand : {skill.what, skill.to}) {
      const std::string name = operand.owner.text + "." + operand.name.text;
      for (const Object& thing : model.objects) {
        if (thing.of && thing.name == name) meant.insert({thing.of->fixture, thing.of->part});
      }
    }
  }
  return meant;
}

}  // namespace

bool says_other_part(const Model& model, const Task& task, Shared& shared, Reporter& reporter) {
  if (has_negation(model.templates[task.say]) || has_words(shared.text(task.say).folded, "except"))
    return false;
  const std::set<PartOf> meant = parts_meant(model, task, shared);
  if (meant.empty()) return false;
  const auto is_meant = [&](const Object& thing) {
    return meant.contains({thing.of->fixture, thing.of->part});
  };
  const std::string& text = shared.text(task.say).folded;
  const auto& parts = model.templates[task.say].parts;
  const auto is_said = [&](const Object& thing) {
    // A region without a name of its own is called like what it is of.
    const bool has_name =
        !thing.of->region ||
        !model.fixtures[thing.of->fixture].regions[*thing.of->region].text.text.empty();
    return (has_name && has_words(text, fold_case(thing.text.text))) ||
           std::any_of(parts.begin(), parts.end(), [&](const Template::Part& part) {
             if (!part.slot) return false;
             if (part.slot->role == RoleId::kNone) return part.slot->name.text == thing.name;
             const auto things = task.things();
             return std::any_of(things.begin(), things.end(), [&](const auto& filled) {
               return filled.first == part.slot->role && &model.objects[filled.second] == &thing;
             });
           });
  };
  // Whose part is meant may speak of others as well, as of the way there.
  if (std::any_of(model.objects.begin(), model.objects.end(), [&](const Object& thing) {
        return thing.of && is_meant(thing) && is_said(thing);
      }))
    return false;
  const auto& fixtures = model.scenes[task.scene].fixtures;
  for (const Object& thing : model.objects) {
    if (!thing.of || is_meant(thing) || !is_said(thing) ||
        std::find(fixtures.begin(), fixtures.end(), thing.of->fixture) == fixtures.end())
      continue;
    report_of(reporter, Code::P1202, task, task.say_span,
              "`" + task.name + "` says `" + thing.name + "`, which its success does not measure")
        .label(model.metrics[task.metrics].span, "judged by these");
    return true;
  }
  return false;
}

}  // namespace probe::sema
