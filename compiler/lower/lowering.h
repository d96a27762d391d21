// The lowering of one task's metrics: expressions of the model become instructions of a program.
// Its own header of this folder; others ask lower.h.
#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/lower/builder.h"
#include "compiler/lower/lower.h"
#include "compiler/model/measures.h"
#include "runtime/base/geometry.h"

namespace probe::lower {

using plan::Op;
using sema::ExprNode;
using sema::ExprOp;
using sema::ExprRef;
using sema::Measure;

using Bodies = std::vector<std::uint16_t>;  // ascending

class Lowering {
 public:
  Lowering(const sema::Model& model, const std::vector<Body>& bodies, const sema::Frame& frame,
           Diagnostics& diagnostics)
      : model_(model), bodies_(bodies), frame_(frame), diagnostics_(diagnostics) {}
  // False when something was reported.
  bool metric(const sema::Metric& metric);
  // The same of a relation of bodies, as the one metric of a program.
  bool relation(const sema::Predicate& relation, std::span<const std::uint16_t> of,
                const Bodies& alike);
  bool claimed(const ClaimedBody& claimed);
  // It is over or in what carries it: of a region between its sides and above its floor, for what
  // is high reaches out of it.
  bool put(const PutBody& put, const Span& span);
  Program finish() { return builder_.finish(); }

 private:
  static constexpr unsigned kSlidesMet = 1, kTurnsMet = 2;
  // Predicates that call others twice double at each level, also where the instructions are shared.
  static constexpr std::size_t kMostVisited = std::size_t{1} << 22u;

  // ---- lower.cpp
  Value related(const sema::Predicate& relation, std::span<const std::uint16_t> of,
                const Bodies& alike);

  // ---- expressions.cpp: values of expressions, in the order of the text
  Value fail(const Span& span, std::string message);
  // Inner expressions first, so that each instruction carries the innermost text that asked for it.
  Value eval(ExprRef ref);
  bool is_travel(const ExprNode& node) const { return node.type.dimension.travel == 1; }
  // Whether it compares or adds what parts have travelled.
  bool joins_travels(const ExprNode& node) const;
  Value value_of(const ExprNode& node);
  Value constant(const ExprNode& node);
  Value vector(const ExprNode& node);
  Value call(const ExprNode& node);
  Value monitor(const ExprNode& node, Op op);
  // Operands first, then the chain of connectives, so that the code reads like the text.
  Value join(const std::vector<Value>& values, bool all, const Span& span);
  Value chain(const ExprNode& node);
  Value quantified(const ExprNode& node);
  Value arithmetic(const ExprNode& node);
  // What is known while lowering becomes a constant of the plan, which holds no infinity.
  Value finite(const Value& value, const Span& span);
  Value negate(const ExprNode& node);
  Value compare(const ExprNode& node, bool or_equal);
  // angle(u, v) <= A  is  cos A |u| |v| <= u . v, since the cosine falls from 0 to pi; no inverse
  // cosine at run time.
  Value compare_angle(const ExprNode& node, bool angle_on_left, bool or_equal);

  // ---- named.cpp: what names stand for in the task
  // The first body that is meant; that there is one was checked.
  template <typename Meant>
  Value only(const ExprNode& node, Meant meant);
  Value in_role(const ExprNode& node);
  // What an open role stands for fits what is measured, or what a predicate takes; else it is
  // reported where that is asked.
  bool fits(const Span& span, const Value& value, char wanted, std::string_view what);
  Value surface() const;
  Value not_here(const ExprNode& node, const std::string& name);
  // The body that a part of a fixture is.
  Value part(const ExprNode& node);
  // Joints are counted over the fixtures of the scene, in the order in which their parts stand.
  Value joint(const ExprNode& node, std::uint32_t fixture, std::uint32_t which);
  // What moves a part, or the joint itself.
  Value joint_of(const ExprNode& node, const Value& value);
  Value of_region(std::uint16_t body, const sema::Region& region);
  Value region(const ExprNode& node);
  Value region_of(const ExprNode& node);
  Value standing(const ExprNode& node);
  Bodies members(sema::SetRef ref);

  // ---- measures.cpp
  // From where it is closed: the limit nearest 0.
  Value travel(const ExprNode& node, const Value& given);
  Value range(const ExprNode& node, const Value& given);
  Value rate(const ExprNode& node, const Value& given);
  // The travel of what slides, or of what turns.
  Value travel_as(const ExprNode& node, const Value& given, bool slides);
  // Each axis between its two bounds, which belong to the region.
  Value within(const Value& where, const Value& of);
  // In the frame of what it belongs to.
  static Mat3 turn_of(const sema::Region& region);
  // A vector of a body's frame, in the world.
  std::uint16_t from_body(std::uint16_t body, const Vec3& vector);
  Value axis(const Value& of, std::uint16_t which);
  Value centre(const Value& of);
  // A body stands for its centre of mass.
  std::uint16_t point(const Value& value);
  // How far right in the picture, as far away as the middle of the area: points of one line of
  // sight have one. Or how far along the ground towards who looks.
  Value in_view(const ExprNode& node, const Value& of, bool is_across);
  Value from_robot(const Value& of, const Vec3& axis);
  std::uint16_t vector_of(const Vec3& v) { return builder_.vector(v.x(), v.y(), v.z()); }
  Value measure(const ExprNode& node);

  const sema::Model& model_;
  const std::vector<Body>& bodies_;
  const sema::Frame& frame_;
  Diagnostics& diagnostics_;
  Builder builder_;
  std::vector<Value> variables_;
  std::optional<Bodies> alike_;
  std::set<Span> empty_;  // of the metric that is being lowered
  unsigned motions_ = 0;  // kSlidesMet, kTurnsMet: of the travels in what is being lowered
  std::size_t visited_ = 0;  // expressions, of kMostVisited
  bool ok_ = true;
};

template <typename Meant>
Value Lowering::only(const ExprNode& node, Meant meant) {
  const auto at = std::find_if(bodies_.begin(), bodies_.end(), meant);
  if (at == bodies_.end()) return fail(node.span, "this is not in the scene");
  return Value::of_body(static_cast<std::uint16_t>(at - bodies_.begin()));
}

}  // namespace probe::lower
