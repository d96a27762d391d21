// `relation`: what it has beside a predicate. Everything it measures is known of a start, so that a
// phrase can be proved in each, and its words are said by phrases that use it.
#include <algorithm>
#include <set>

#include "compiler/define/expr.h"
#include "compiler/define/query.h"
#include "runtime/base/utf8.h"

namespace probe::sema {
namespace {

// The first part of a relation that no start answers.
struct Fault {
  Span span;
  std::string message;
};

// Visits a relation's expression and those of the predicates that it calls, each once.
class Search {
 public:
  explicit Search(const Model& model) : model_(model) {}

  // Whether what was visited names those alike.
  bool has_alike() const { return has_alike_; }

  std::optional<Fault> in(ExprRef ref) {
    if (ref == kNoExpr || !seen_.insert(ref).second) return std::nullopt;
    const ExprNode& node = model_.exprs.nodes[ref];
    if (auto fault = own(node)) return fault;
    for (const ExprRef arg : node.args) {
      if (auto fault = in(arg)) return fault;
    }
    return node.op == ExprOp::kCall ? in(model_.predicates[node.predicate].body) : std::nullopt;
  }

 private:
  static std::optional<Fault> own(const ExprNode& node, std::string_view what) {
    return Fault{node.span, std::string(what) + " is not known before anything moves"};
  }

  std::optional<Fault> own(const ExprNode& node) {
    switch (node.op) {
      case ExprOp::kMeasure: {
        const MeasureInfo& measure = info(node.measure);
        if (measure.of_start) return std::nullopt;
        return own(node, "`" + std::string(measure.name) + "`");
      }
      case ExprOp::kOnce:
      case ExprOp::kAlways:
      case ExprOp::kHold:
        return own(node, "what was");
      case ExprOp::kSurface:
        return Fault{node.span, "a relation is one of objects, the surface is none"};
      case ExprOp::kPart:
      case ExprOp::kStanding:
        return Fault{node.span, "a relation is one of objects, a fixture is none"};
      case ExprOp::kAny:
      case ExprOp::kAll:
      case ExprOp::kNo:
        return in_set(node.set);
      default:
        return std::nullopt;
    }
  }

  std::optional<Fault> in_set(SetRef ref) {
    const SetNode& set = model_.exprs.sets[ref];
    switch (set.op) {
      case SetOp::kAlike:
        has_alike_ = true;
        return std::nullopt;
      case SetOp::kFingers:
      case SetOp::kLinks:
      case SetOp::kBodies:
      case SetOp::kParts:
      case SetOp::kWhole:
        return Fault{set.span, "a relation is one of objects, this set has others"};
      case SetOp::kUnion:
      case SetOp::kIntersection:
      case SetOp::kDifference: {
        const auto fault = in_set(set.left);
        return fault ? fault : in_set(set.right);
      }
      default:
        return std::nullopt;
    }
  }

  const Model& model_;
  std::set<ExprRef> seen_;
  bool has_alike_ = false;
};

}  // namespace

std::size_t objects_of(const syntax::PredicateDecl& relation) {
  std::size_t count = 0;
  for (const syntax::Param& param : relation.params)
    count += param.type == syntax::ParamType::kObject ? 1 : 0;
  return count;
}

void check_relation(Context& context, const syntax::PredicateDecl& node, Predicate& relation) {
  relation.is_relation = true;
  relation.objects = static_cast<std::uint32_t>(objects_of(node));
  for (const syntax::Text& word : node.words) {
    if (is_blank(word.value))
      context.report(Situation::kRelationWords, word.span, "a relation has words that say it");
    relation.words.push_back(fold_case(word.value));
  }
  const auto& parameters = relation.parameters;
  bool is_fillable = relation.objects >= 1 && relation.objects <= 3;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const bool is_object =
        parameters[i].type.kind == TypeKind::kBody && parameters[i].type.is_object;
    is_fillable =
        is_fillable && (i < relation.objects ? is_object && parameters[i].default_value == kNoExpr
                                             : parameters[i].default_value != kNoExpr);
  }
  if (!is_fillable)
    context.report(Situation::kRelationParameters, node.name.span,
                   "a relation takes one to three objects; whatever stands behind them has a "
                   "default");
  if (relation.type.kind == TypeKind::kPoison) return;
  if (relation.type.kind != TypeKind::kBool) {
    context.report(Code::P0601, node.name.span,
                   "expected a condition, found " + type_name(relation.type));
    return;
  }
  Search search(context.model);
  const auto fault = search.in(relation.body);
  relation.is_comparison = search.has_alike();
  if (fault)
    context.report(Situation::kRelationMeasure, fault->span, fault->message)
        .label(node.name.span, "in this relation");
}

}  // namespace probe::sema
