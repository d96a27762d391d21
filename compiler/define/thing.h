// What fills a role: an object, or a part or a region of a fixture, which stand as rows behind the
// objects that are declared: they have words, facts and phrases as those do, and no place of their
// own.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// `carrot` or `cabinet.top_drawer`; nothing where there is none.
std::optional<ObjectId> peek_thing(const Context& context, std::string_view name);
// The same; P0201 with what there is.
std::optional<ObjectId> find_thing(Context& context, const syntax::Name& name);

// The two names of `cabinet.top_drawer`; nothing for one without a dot.
std::optional<std::pair<syntax::Name, syntax::Name>> halves_of(const syntax::Name& name);

// Rows for the declared parts and the regions of all fixtures.
void define_things(Context& context);

// What is said of an object's looks, names and phrases, over what it has.
void read_look(Context& context, const syntax::File& file,
               const std::vector<syntax::ObjectStmt>& body, Object& object);

// The declared parts of the fixtures of a task's scene, in the order of their bodies.
std::vector<ObjectId> parts_in_scene(const Model& model, const Task& task);
// Its objects, and those of the parts of which something is said that a phrase may ask, or that
// fill a role: what words may denote.
std::vector<ObjectId> denotable(const Model& model, const Task& task);

// Parts and regions that fill roles, with those, and parts that are distractors, which fill none.
std::vector<std::pair<RoleId, ObjectId>> things_of(const Task& task);

// "a part", "a region", "an object".
const char* kind_of(const Object& object);

}  // namespace probe::sema
