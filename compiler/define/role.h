// Roles by name, wherever a text may say one.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// A word that stands for bodies wherever a role may stand: nothing else is called so.
bool is_taken_word(std::string_view word);

// Source, target or a declared role; nothing for any other word.
std::optional<RoleId> find_role(const Context& context, std::string_view word);
// The same of a finished model.
std::optional<RoleId> find_role(const Model& model, std::string_view word);

// What a text may say where it says a role.
std::vector<std::string_view> role_names(const Context& context);

// A role that stands for one object; P0201 for another word, P1105 for a set.
std::optional<RoleId> find_single_role(Context& context, const syntax::Name& name);

// "the carrot, the spoon and the towel".
std::string list_of(const std::vector<std::string>& words);

}  // namespace probe::sema
