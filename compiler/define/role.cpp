// `role`: who else takes part in a task, beside source, target and distractors.
#include "compiler/define/role.h"

#include <algorithm>
#include <array>
#include <set>

#include "compiler/define/define.h"
#include "compiler/syntax/words.h"

namespace probe::sema {
namespace {

// Words that stand for bodies already, wherever a role may stand.
constexpr std::array<std::string_view, 16> kTaken = {
    "source",  "target", "distractors", "distractor", "surface", "objects", "others", "bodies",
    "fingers", "links",  "none",        "avoided",    "placed",  "the",     "all",    "both"};

// The roles that some task fills with a part or a region, and those that a `derive` fills with what
// it binds to parts: of those only each task knows what they stand for.
std::set<std::string_view> roles_of_things(const Context& context) {
  std::set<std::string_view> roles;
  std::vector<std::string_view> bound;
  const auto is_thing = [&](const syntax::Name& name) {
    return name.text.find('.') != name.text.npos ||
           std::ranges::find(bound, name.text) != bound.end();
  };
  const auto look = [&](const std::vector<syntax::TaskStmt>& body) {
    for (const syntax::TaskStmt& stmt : body) {
      if (const auto* field = std::get_if<syntax::FieldStmt>(&stmt)) {
        if (field->field == syntax::TaskField::kSource && is_thing(field->value))
          roles.insert("source");
        if (field->field == syntax::TaskField::kTarget && is_thing(field->value))
          roles.insert("target");
      } else if (const auto* role = std::get_if<syntax::RoleStmt>(&stmt)) {
        if (std::ranges::any_of(role->objects, is_thing)) roles.insert(role->role.text);
      } else if (const auto* others = std::get_if<syntax::DistractorsStmt>(&stmt)) {
        if (std::ranges::any_of(others->objects, is_thing)) roles.insert("distractors");
      }
    }
  };
  for (const DeclaredTask& task : context.symbols.task_decls) look(*task.body);
  for (const auto& derive : context.symbols.derive_decls) {
    bound.clear();
    for (const syntax::Binder& binder : derive.node->binders) {
      const auto* objects = std::get_if<syntax::BinderObjects>(&binder.over);
      const auto* others = std::get_if<syntax::BinderDistractors>(&binder.over);
      if ((objects != nullptr && std::ranges::any_of(objects->objects, is_thing)) ||
          (others != nullptr && others->role.text == "parts"))
        bound.push_back(binder.name.text);
    }
    look(derive.node->body);
  }
  return roles;
}

}  // namespace

bool is_taken_word(std::string_view word) {
  return std::ranges::find(kTaken, word) != kTaken.end();
}

std::optional<RoleId> find_role(const Context& context, std::string_view word) {
  if (word == "source") return RoleId::kSource;
  if (word == "target") return RoleId::kTarget;
  if (const auto declared = context.symbols.roles.peek(word))
    return static_cast<RoleId>(*declared + 2);
  return std::nullopt;
}

std::optional<RoleId> find_role(const Model& model, std::string_view word) {
  for (std::size_t i = 0; i < model.roles.size(); ++i) {
    if (model.roles[model.roles.id(i)].name == word) return model.roles.id(i);
  }
  return std::nullopt;
}

std::vector<std::string_view> role_names(const Context& context) {
  std::vector<std::string_view> names = {"source", "target"};
  for (const syntax::Name& role : context.symbols.roles.names()) names.push_back(role.text);
  return names;
}

std::optional<RoleId> find_single_role(Context& context, const syntax::Name& name) {
  const auto role = find_role(context, name.text);
  if (!role) {
    report_unknown(context.diagnostics, "role", name, role_names(context));
    return std::nullopt;
  }
  const Role& record = context.model.roles[*role];
  if (!record.is_set) return role;
  context
      .report(Code::P1105, name.span,
              "`" + record.name + "` is a set, and one object is wanted here")
      .label(record.span, "declared as a set");
  return std::nullopt;
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
  return text;
}

void define_roles(Context& context) {
  const std::set<std::string_view> things = roles_of_things(context);
  context.model.has_part_distractors = things.contains("distractors");
  context.model.roles.add({"source", {}, false, things.contains("source")});
  context.model.roles.add({"target", {}, false, things.contains("target")});
  for (const auto& declared : context.symbols.role_decls) {
    const syntax::RoleDecl& node = *declared.node;
    context.model.roles.add({std::string(node.name.text), node.name.span, node.is_set,
                             things.contains(node.name.text)});
    if (node.name.text.empty()) continue;  // a syntax error, reported
    const std::string_view name = node.name.text;
    const bool is_taken = is_taken_word(name);
    const bool is_statement = syntax::find_statement(syntax::Block::kTask, name) != nullptr;
    const auto object = context.symbols.objects.peek(name);
    if (!is_taken && !is_statement && !object) continue;
    Diagnostic& taken = context.report(Code::P1101, node.name.span,
                                       "`" + std::string(name) + "` cannot be a role: " +
                                           (object         ? "an object is called so"
                                            : is_statement ? "a statement of tasks begins with it"
                                                           : "the word stands for bodies already"));
    if (object) taken.label(context.symbols.objects.names()[*object].span, "the object");
  }
}

}  // namespace probe::sema
