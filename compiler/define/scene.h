// Scenes that tasks change: a copy of the task's scene with other statements.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "compiler/names/context.h"

namespace probe::sema {

// What a name of the text stands for: another one where a `derive` binds it, else itself.
using NameBound = std::function<syntax::Name(const syntax::Name&)>;

// Whether the text has the word, not as a part of a longer one.
bool says_word(std::string_view text, std::string_view word);

// The scene `from` as the block of a task changes it: a row behind the declared ones, called as
// `from` is. The same block, over the same scene and under the same `bindings`, is one row. A
// mistake is reported, and the row is broken.
SceneId change_scene(Context& context, SceneId from, const syntax::TaskSceneStmt& stmt,
                     const NameBound& bound, const std::string& bindings);

}  // namespace probe::sema
