#include "compiler/define/option_words.h"

#include <algorithm>

#include "compiler/define/query.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

bool fits_alone(const Model& model, const std::vector<AskedOption>& options, const Phrase& phrase,
                std::size_t option) {
  if (is_blank(phrase.text.text)) return false;
  for (std::size_t k = 0; k < options.size(); ++k) {
    const Truth truth = evaluate(phrase.means, model.objects[options[k].object]);
    if (truth != (k == option ? Truth::kYes : Truth::kNo)) return false;
  }
  return true;
}

}  // namespace

void add_option_words(const Model& model, const SceneObjects& scene, AskedQuestion& question) {
  struct Words {
    std::string text, folded;
  };
  std::vector<AskedOption>& options = question.options;
  std::vector<std::vector<Words>> candidates(options.size());
  const auto calls = [&](std::size_t i, std::string_view folded) {
    return scene.name(options[i].object) == folded ||
           std::any_of(candidates[i].begin(), candidates[i].end(),
                       [&](const Words& words) { return words.folded == folded; });
  };
  for (std::size_t i = 0; i < options.size(); ++i) {
    const Object& object = model.objects[options[i].object];
    const std::string& name = object.text.text;
    const auto propose = [&](const std::string& text, const std::string& folded) {
      if (!calls(i, folded)) candidates[i].push_back({text, folded});
    };
    const std::size_t blank = name.rfind(' ');
    if (blank != std::string::npos && blank + 1 < name.size())
      propose(name.substr(blank + 1), fold_case(name.substr(blank + 1)));
    for (std::size_t p = 0; p < object.phrases.size(); ++p) {
      const std::string& folded = scene.names().phrase(options[i].object, p);
      if (fits_alone(model, options, object.phrases[p], i))
        propose(object.phrases[p].text.text, folded);
    }
  }
  for (std::size_t i = 0; i < options.size(); ++i) {
    for (Words& words : candidates[i]) {
      bool is_free = true;
      for (std::size_t k = 0; k < options.size() && is_free; ++k) {
        is_free = k == i || (!calls(k, words.folded) &&
                             !has_words(scene.name(options[k].object), words.folded));
      }
      if (is_free) options[i].words.push_back(words.text);
    }
  }
}

}  // namespace probe::sema
