// P1510 as a warning: what a task calls an object that was painted or covered anew has the word of
// another colour. A name that has such a word for another reason, as of orange juice, is why it is
// no mistake.
#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/define/template.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {

void check_look_words(const Model& model, Reporter& reporter) {
  const Attribute* colors = nullptr;
  std::size_t at = 0;  // of an object's values
  for (std::size_t i = 0; i < model.attributes.size() && colors == nullptr; ++i) {
    if (model.attributes[model.attributes.id(i)].name != "color") continue;
    colors = &model.attributes[model.attributes.id(i)];
    at = i;
  }
  if (colors == nullptr) return;
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
