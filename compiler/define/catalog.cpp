// The catalogue: datasets, attributes, facts and objects, with queries turned into postfix
// programs.
#include "compiler/define/axes.h"
#include "compiler/define/passes.h"

namespace probe::sema {
namespace {

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
  if (const auto near = nearest(value.text, candidates)) {
    diagnostic.point("did you mean `" + std::string(*near) + "`?")
        .fix_by("write `" + std::string(*near) + "`", value.span, std::string(*near));
  }
  diagnostic.label(context.symbols.attributes.names()[static_cast<std::size_t>(attribute)].span,
                   "the values of `" + record.name + "` are listed here");
  return std::nullopt;
}

// Appends `id` in postfix order. The depth is bounded by the parser.
bool compile_query(Context& context, const syntax::File& file, syntax::QueryId id, Query& out) {
  if (id.value == syntax::QueryId::kNone) return false;  // a syntax error, reported
  const auto& node = file[id].node;
  if (const auto* fact = std::get_if<syntax::QueryFact>(&node)) {
    const auto found = context.symbols.facts.find(fact->fact, context.diagnostics);
    if (!found) return false;
    out.push_back({QueryOp::kFact, *found, 0});
    return true;
  }
  if (const auto* value = std::get_if<syntax::QueryValue>(&node)) {
    const auto attribute = context.symbols.attributes.find(value->attribute, context.diagnostics);
    if (!attribute) return false;
    const auto found = find_value(context, static_cast<AttributeId>(*attribute), value->value);
    if (!found) return false;
    out.push_back({QueryOp::kValue, *attribute, *found});
    return true;
  }
  if (const auto* negation = std::get_if<syntax::QueryNot>(&node)) {
    if (!compile_query(context, file, negation->operand, out)) return false;
    out.push_back({QueryOp::kNot, 0, 0});
    return true;
  }
  const auto binary = [&](syntax::QueryId left, syntax::QueryId right, QueryOp::Kind kind) {
    if (!compile_query(context, file, left, out) || !compile_query(context, file, right, out))
      return false;
    out.push_back({kind, 0, 0});
    return true;
  };
  if (const auto* both = std::get_if<syntax::QueryAnd>(&node))
    return binary(both->left, both->right, QueryOp::kAnd);
  const auto& either = std::get<syntax::QueryOr>(node);
  return binary(either.left, either.right, QueryOp::kOr);
}

// Reads the statements of one object over what it copied.
struct ObjectReader {
  Context& context;
  const syntax::File& file;
  Object& object;
  bool has_is = false, has_maybe = false, has_seen = false;

  void facts(const std::vector<syntax::Name>& names, Truth truth, bool& begun) {
    // Statements overwrite: a new list replaces the copied one of its kind.
    if (!begun) {
      for (Truth& fact : object.facts) {
        if (fact == truth) fact = Truth::kNo;
      }
    }
    begun = true;
    for (const syntax::Name& name : names) {
      if (const auto fact = context.symbols.facts.find(name, context.diagnostics))
        object.facts[*fact] = truth;
    }
  }

  void begin_box(const Span& span) {
    object.has_box = object.box_is_read = true;
    object.box_span = span;
  }

  void operator()(const syntax::MeshStmt& stmt) { object.mesh = spelled(stmt.path); }
  void operator()(const syntax::BoxSizeStmt& stmt) {
    const syntax::Quantity* sides[] = {&stmt.x, &stmt.y, &stmt.z};
    begin_box(stmt.span);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto side = read_positive(context, *sides[i], dim::kLength, "`box` takes lengths");
      if (!side) {
        object.box_is_read = false;
        continue;
      }
      // Halving is exact in binary, so the corners are the nearest doubles to the exact ones.
      object.box_min[i] = -*side / 2;
      object.box_max[i] = *side / 2;
    }
  }
  void operator()(const syntax::BoxCornersStmt& stmt) {
    begin_box(stmt.span);
    object.box_is_read = false;
    const auto low = read_point(context, stmt.low, 3, 3, dim::kLength, "`box` takes lengths");
    const auto high = read_point(context, stmt.high, 3, 3, dim::kLength, "`box` takes lengths");
    if (!low || !high) return;
    for (std::size_t i = 0; i < 3; ++i) {
      object.box_min[i] = (*low)[i].si();
      object.box_max[i] = (*high)[i].si();
      if (object.box_min[i] < object.box_max[i]) continue;
      context.report(Code::P0304, stmt.span,
                     "the second corner of a box lies above the first on every axis");
      return;
    }
    object.box_is_read = true;
  }
  void operator()(const syntax::DensityStmt& stmt) {
    object.has_density = true;
    object.density =
        read_positive(context, stmt.value, dim::kDensity, "`density` takes a density").value_or(1);
  }
  void operator()(const syntax::FrictionStmt& stmt) {
    object.has_friction = true;
    object.friction =
        read_positive(context, stmt.value, dim::kNumber, "`friction` takes a number").value_or(1);
  }
  void operator()(const syntax::IsStmt& stmt) { facts(stmt.facts, Truth::kYes, has_is); }
  void operator()(const syntax::MaybeStmt& stmt) { facts(stmt.facts, Truth::kUnknown, has_maybe); }
  void operator()(const syntax::SeenInStmt& stmt) {
    if (!has_seen) object.seen_in.clear();
    has_seen = true;
    object.unseen = false;
    for (const syntax::Name& name : stmt.datasets) {
      const auto dataset = context.symbols.datasets.find(name, context.diagnostics);
      if (dataset) object.seen_in.push_back(static_cast<DatasetId>(*dataset));
    }
  }
  void operator()(const syntax::UnseenStmt&) {
    object.seen_in.clear();
    object.unseen = true;
  }
  void operator()(const syntax::RestStmt& stmt) {
    if (const auto turns = read_turns(context, stmt.poses)) object.rest = *turns;
  }
  void operator()(const syntax::NameStmt& stmt) {
    object.text = spelled(stmt.text);
    if (object.text.text.find_first_not_of(' ') == std::string::npos)
      context.report(Code::P0406, object.text.span, "an object's name has no words");
    object.bare = stmt.bare;
  }
  void operator()(const syntax::PhraseStmt& stmt) {
    Phrase phrase{std::string(stmt.name.text),
                  plan::Axis::kLanguageAppearance,
                  spelled(stmt.text),
                  stmt.bare,
                  {},
                  {}};
    if (const auto axis = phrase_axis(context.diagnostics, stmt.axis)) phrase.axis = *axis;
    if (!compile_query(context, file, stmt.means, phrase.means)) return;
    phrase.means_text = std::string(context.sources.text(file[stmt.means].span));
    for (Phrase& known : object.phrases) {
      if (known.name != phrase.name) continue;
      known = std::move(phrase);
      return;
    }
    object.phrases.push_back(std::move(phrase));
  }
  void operator()(const syntax::AttributeStmt& stmt) {
    const auto attribute = context.symbols.attributes.find(stmt.attribute, context.diagnostics);
    if (!attribute) return;
    std::vector<std::uint32_t>& values = object.values[*attribute];
    values.clear();
    for (const syntax::Name& name : stmt.values) {
      if (const auto value = find_value(context, static_cast<AttributeId>(*attribute), name))
        values.push_back(*value);
    }
  }
};

void require(Context& context, const Object& object, bool there, const char* statement) {
  if (there) return;
  context.report(Code::P0206, object.span,
                 "object `" + object.name + "` has no `" + statement + "`");
}

void define_objects(Context& context) {
  const auto& decls = context.symbols.object_decls;
  std::vector<std::optional<std::uint32_t>> parents(decls.size());
  std::vector<bool> broken(decls.size(), false);  // reported; what it lacks follows from that
  for (std::size_t i = 0; i < decls.size(); ++i) {
    context.model.objects.add({});
    if (decls[i].node->like)
      parents[i] = context.symbols.objects.find(*decls[i].node->like, context.diagnostics);
  }
  for (const std::uint32_t i : parents_first(context, parents, context.symbols.objects.names())) {
    const syntax::ObjectDecl& node = *decls[i].node;
    Object object;
    if (parents[i]) object = context.model.objects[static_cast<ObjectId>(*parents[i])];
    object.name = std::string(node.name.text);
    object.span = node.name.span;
    object.values.resize(context.model.attributes.size());
    object.facts.resize(context.model.facts.size(), Truth::kNo);
    ObjectReader reader{context, *decls[i].file, object};
    const auto errors = context.mistakes();
    for (const syntax::ObjectStmt& stmt : node.body) std::visit(reader, stmt);
    broken[i] = !decls[i].decl->complete || (node.like && !parents[i]) ||
                (parents[i] && broken[*parents[i]]);
    if (!broken[i]) {
      require(context, object, !object.mesh.span.is_none(), "mesh");
      require(context, object, object.has_box, "box");
      require(context, object, object.has_density, "density");
      require(context, object, object.has_friction, "friction");
      require(context, object, !object.text.span.is_none(), "name");
    }
    object.broken = broken[i] = broken[i] || context.mistakes() != errors;
    if (object.rest.empty()) object.rest.push_back({});
    context.model.objects[static_cast<ObjectId>(i)] = std::move(object);
  }
}

void define_datasets(Context& context) {
  for (const auto& declared : context.symbols.dataset_decls) {
    Dataset dataset{std::string(declared.node->name.text), declared.node->title.value, {}};
    for (const syntax::RelationsStmt& stmt : declared.node->body) {
      for (const syntax::Relation& relation : stmt.relations) {
        const auto subject = context.symbols.objects.find(relation.subject, context.diagnostics);
        const auto object = context.symbols.objects.find(relation.object, context.diagnostics);
        if (!subject || !object) continue;
        dataset.relations.push_back(
            {static_cast<ObjectId>(*subject), static_cast<ObjectId>(*object)});
      }
    }
    context.model.datasets.add(std::move(dataset));
  }
}

}  // namespace

const Phrase* Object::find_phrase(std::string_view phrase) const {
  for (const Phrase& known : phrases) {
    if (known.name == phrase) return &known;
  }
  return nullptr;
}

void define_catalog(Context& context) {
  define_attributes(context);
  define_objects(context);
  define_datasets(context);
}

}  // namespace probe::sema
