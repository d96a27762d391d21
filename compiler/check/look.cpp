// P1510 as a warning: a copy that is said to be of another colour than its mesh is, and what a task
// calls an object that was painted or covered anew has the word of another colour. A name that has
// such a word for another reason, as of orange juice, is why it is no mistake.
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/define/template.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

// A copy that is said to be of another colour and shows the same mesh: nobody sees what is said.
void check_copies(const Model& model, std::size_t color, Reporter& reporter) {
  std::map<std::string_view, ObjectId> shown;
  for (std::size_t i = 0; i < model.objects.size(); ++i) {
    const ObjectId id = model.objects.id(i);
    const Object& object = model.objects[id];
    if (object.of || object.broken || object.paint || object.texture || object.mesh.text.empty() ||
        object.values[color].empty())
      continue;
    const auto [at, is_first] = shown.emplace(object.mesh.text, id);
    const std::vector<std::uint32_t>& own = object.values[color];
    const std::vector<std::uint32_t>& other = model.objects[at->second].values[color];
    if (is_first || std::any_of(own.begin(), own.end(), [&](std::uint32_t value) {
          return std::find(other.begin(), other.end(), value) != other.end();
        }))
      continue;
    const Attribute& colors = model.attributes[model.attributes.id(color)];
    reporter
        .report(Code::P1510, object.span,
                "`" + object.name + "` is said to be " + colors.values[own.front()] +
                    " and shows the mesh of `" + model.objects[at->second].name + "`, which is " +
                    colors.values[other.front()])
        .label(model.objects[at->second].span, "declared here")
        .help("show it: `paint " + colors.values[own.front()] + "`")
        .severity = Severity::kWarning;
  }
}

}  // namespace

void check_look_words(const Model& model, Reporter& reporter) {
  const Attribute* colors = nullptr;
  std::size_t at = 0;  // of an object's values
  for (std::size_t i = 0; i < model.attributes.size() && colors == nullptr; ++i) {
    if (model.attributes[model.attributes.id(i)].name != "color") continue;
    colors = &model.attributes[model.attributes.id(i)];
    at = i;
  }
  if (colors == nullptr) return;
  check_copies(model, at, reporter);
  if (reporter.has_errors()) return;  // a phrase that does not denote is no word of a colour
  std::set<std::pair<ObjectId, std::string>> told;
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete) continue;
    for (const ObjectId id : task.objects()) {
      const Object& object = model.objects[id];
      if ((!object.paint && !object.texture) || task.role_of(id) == RoleId::kNone) continue;
      const Referring said = referring(model, task, id);
      if (said.text == nullptr || told.contains({id, *said.text})) continue;
      const std::string text = fold_case(*said.text);
      const std::vector<std::uint32_t>& own = object.values[at];
      for (std::uint32_t value = 0; value < colors->values.size(); ++value) {
        if (!has_words(text, colors->values[value]) ||
            std::find(own.begin(), own.end(), value) != own.end())
          continue;
        told.emplace(id, *said.text);
        const About about(reporter, task.decl_span);
        reporter
            .report(Code::P1510, task.span,
                    "`" + task.name + "` calls `" + object.name + "` \"" + *said.text + "\"" +
                        (own.empty() ? ", whose colour is not known any more"
                                     : ", which is not " + colors->values[value] + " any more"))
            .label(object.span, object.paint ? "painted anew" : "covered anew")
            .help("say what is seen: a `name` or a phrase of its own")
            .severity = Severity::kWarning;
        break;
      }
    }
  }
}

}  // namespace probe::sema
