// Expressions of predicates and metrics: names resolved, types and dimensions checked. Says which
// numbers have which dimension; how they are measured is the lowering's business.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/measures.h"
#include "compiler/names/context.h"

namespace probe::sema {

inline Type real_type(const Dimension& dimension) { return {TypeKind::kReal, dimension}; }
inline Type bool_type() { return {TypeKind::kBool, dim::kNumber}; }
// "an object", "a length": for messages.
std::string type_name(const Type& type);

// Reads the expressions of one predicate or metric. Recursion is bounded by the parser's depth, and
// through the predicates that are called by kMaxLevels.
class ExprReader {
 public:
  struct Variable {
    std::string_view name;
    Type type;
    std::uint32_t index;
  };

  ExprReader(Context& context, const syntax::File& file) : context_(context), file_(file) {}

  // A relation's body may name the set `alike`.
  void read_relation() { is_relation_ = true; }
  void add_variable(std::string_view name, const Type& type);
  std::uint32_t variables() const { return variables_; }

  ExprRef condition(syntax::ExprId id) { return expect(read(id), TypeKind::kBool, "a condition"); }
  ExprRef number(syntax::ExprId id) { return expect(read(id), TypeKind::kReal, "a number"); }

  ExprRef read(syntax::ExprId id);

  const ExprNode& node(ExprRef ref) const { return context_.model.exprs.nodes[ref]; }

 private:
  ExprArena& arena() { return context_.model.exprs; }

  ExprRef add(ExprNode node);
  ExprRef add(ExprOp op, const Type& type, const Span& span, std::vector<ExprRef> args = {},
              std::uint32_t a = 0);
  ExprRef poison(const Span& span) { return add(ExprOp::kPoison, Type{}, span); }
  bool is_poison(ExprRef ref) const { return node(ref).type.kind == TypeKind::kPoison; }

  // One mistake, one message: poison passes silently.
  ExprRef expect(ExprRef ref, TypeKind kind, const char* wanted);
  // `angle(u, v)` has no value of its own on the judge: only its comparison with a constant has.
  ExprRef plain(ExprRef ref);
  bool same_dimension(ExprRef left, ExprRef right);

  ExprRef read_node(const Span& span, const syntax::ExprNumber& number);

  ExprRef read_node(const Span& span, const syntax::ExprName& name);

  ExprRef read_node(const Span& span, const syntax::ExprPath& path);
  ExprRef add_of(ExprOp op, const Type& type, const Span& span, FixtureId fixture,
                 std::size_t which);
  ExprRef of_fixture(const Span& span, FixtureId id, const syntax::Name& name);
  ExprRef region_of(const Span& span, ExprRef body, const syntax::Name& name);
  Dimension travel_of(ExprRef ref) const;

  std::optional<ExprRef> body_name(const syntax::Name& name);
  std::optional<ExprRef> named_body(const syntax::Name& name);

  ExprRef read_node(const Span& span, const syntax::ExprCall& call);

  ExprRef read_measure(const Span& span, const syntax::ExprCall& call, const MeasureInfo& measure);

  bool argument_fits(const MeasureInfo& measure, std::size_t i, ExprRef arg);

  ExprRef add_measure(const Span& span, const MeasureInfo& measure, std::vector<ExprRef> args);

  ExprRef read_predicate(const Span& span, const syntax::ExprCall& call, PredicateId id);

  ExprRef read_node(const Span& span, const syntax::ExprVector& vector);

  ExprRef read_node(const Span& span, const syntax::ExprUnary& unary);
  ExprRef negate_vector(const Span& span, ExprRef operand);

  ExprRef read_node(const Span& span, const syntax::ExprBinary& binary);

  ExprRef logical(const Span& span, const syntax::ExprBinary& binary);

  ExprRef comparison(const Span& span, syntax::BinaryOp op, ExprRef left, ExprRef right);

  ExprRef arithmetic(const Span& span, const syntax::ExprBinary& binary, ExprRef left,
                     ExprRef right);

  ExprRef read_node(const Span& span, const syntax::ExprHold& hold);

  ExprRef read_node(const Span& span, const syntax::ExprBlock& block);

  ExprRef read_node(const Span& span, const syntax::ExprQuantified& quantified);

  bool only_objects(SetRef ref);
  bool only_parts(SetRef ref);
  // Whether some task has parts in it.
  bool may_have_parts(SetRef ref);

  ExprRef read_thing(const syntax::Name& name);
  std::optional<SetRef> read_set(syntax::SetExprId id);

  Context& context_;
  const syntax::File& file_;
  std::vector<Variable> scope_;
  std::uint32_t variables_ = 0;
  bool is_relation_ = false;
};

// Sets what a relation has beside a predicate. Reported: measures that no start has, words that are
// none, parameters that no phrase can fill.
void check_relation(Context& context, const syntax::PredicateDecl& node, Predicate& relation);

}  // namespace probe::sema
