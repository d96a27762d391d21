// `role`: who else takes part in a task, beside source, target and distractors.
#include "compiler/define/role.h"

#include <algorithm>
#include <array>

#include "compiler/define/define.h"
#include "compiler/syntax/words.h"

namespace probe::sema {
namespace {

// Words that stand for bodies already, wherever a role may stand.
constexpr std::array<std::string_view, 16> kTaken = {
    "source",  "target", "distractors", "distractor", "surface", "objects", "others", "bodies",
    "fingers", "links",  "none",        "avoided",    "placed",  "the",     "all",    "both"};

}  // namespace

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
  context.model.roles.add({"source", {}, false});
  context.model.roles.add({"target", {}, false});
  for (const auto& declared : context.symbols.role_decls) {
    const syntax::RoleDecl& node = *declared.node;
    context.model.roles.add({std::string(node.name.text), node.name.span, node.is_set});
    if (node.name.text.empty()) continue;  // a syntax error, reported
    const std::string_view name = node.name.text;
    const bool is_taken = std::find(kTaken.begin(), kTaken.end(), name) != kTaken.end();
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
