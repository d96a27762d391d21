// Sets of tasks from the expressions that name them. Sets may name one another in any order.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

class SetReader {
 public:
  // kPreview: while tasks are still being made. Sets are then read without a word, since
  // define_sets() will read them again. kDefined: it has.
  enum class Mode : std::uint8_t { kPreview, kDefine, kDefined };
  SetReader(Context& context, Mode mode);

  void define(SetId id);
  std::vector<TaskId> read(const syntax::File& file, syntax::TaskSetId id);
  // What samples cut in the sets that were read since the last call.
  std::vector<CutComparison> take_cuts() { return std::exchange(cuts_, {}); }

  // The words a condition may use; to be checked once, before any task is asked.
  bool check_condition(const syntax::File& file, syntax::CondId id);
  // An incomplete task meets no test.
  bool holds(const syntax::File& file, syntax::CondId id, const Task& task) const;

 private:
  enum State : std::uint8_t { kNew, kOpen, kDone };
  using Members = std::vector<TaskId>;

  Members read_node(const syntax::File&, const Span&, const syntax::TaskSetNames& names);
  Members read_node(const syntax::File& file, const Span&, const syntax::TaskSetName& set);
  Members read_node(const syntax::File& file, const Span&, const syntax::TaskSetVariants& of);
  Members read_node(const syntax::File& file, const Span&, const syntax::TaskSetSample& sample);
  Members read_node(const syntax::File& file, const Span&, const syntax::TaskSetBinary& binary);
  Members read_node(const syntax::File& file, const Span&, const syntax::TaskSetWhere& where);
  bool holds(const syntax::CondTest& test, const Task& task) const;
  void add_baselines(Members& members) const;

  Context& context_;
  bool preview_;
  Diagnostics unheard_;
  Diagnostics* diagnostics_;
  std::vector<State> states_;
  std::vector<CutComparison> cuts_;
};

}  // namespace probe::sema
