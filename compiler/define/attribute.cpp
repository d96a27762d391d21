// `attribute` and `facts`: what can be said of objects.
#include "compiler/define/attribute.h"

#include "compiler/define/define.h"

namespace probe::sema {

void define_attributes(Context& context) {
  for (const auto& declared : context.symbols.attribute_decls) {
    Attribute attribute{std::string(declared.node->name.text), {}};
    NameTable seen("value");
    for (const syntax::Name& value : declared.node->values) {
      if (seen.declare(value, context.diagnostics)) attribute.values.emplace_back(value.text);
    }
    context.model.attributes.add(std::move(attribute));
  }
  for (const syntax::Name& fact : context.symbols.facts.names())
    context.model.facts.emplace_back(fact.text);
}

std::optional<std::uint32_t> find_value(Context& context, AttributeId attribute,
                                        const syntax::Name& value) {
  const Attribute& record = context.model.attributes[attribute];
  std::vector<std::string_view> candidates;
  for (std::uint32_t i = 0; i < record.values.size(); ++i) {
    if (record.values[i] == value.text) return i;
    candidates.push_back(record.values[i]);
  }
  Diagnostic& diagnostic = context.report(Code::P0204, value.span,
                                          "`" + std::string(value.text) + "` is no " + record.name);
  diagnostic.subject = record.name + " " + std::string(value.text);
  if (const auto near = nearest(value.text, candidates)) {
    diagnostic.point("did you mean `" + std::string(*near) + "`?")
        .fix_by("write `" + std::string(*near) + "`", value.span, std::string(*near));
  }
  diagnostic.label(context.symbols.attributes.names()[static_cast<std::size_t>(attribute)].span,
                   "the values of `" + record.name + "` are listed here");
  return std::nullopt;
}

}  // namespace probe::sema
