#include "compiler/language/hints.h"

#include <algorithm>
#include <map>

#include "runtime/plan/axes.h"

namespace probe::language {
namespace {

constexpr std::size_t kLongest = 70;  // bytes of an instruction

// "1,224".
std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
  return text;
}

std::string counted(std::uint64_t number, const char* thing) {
  return grouped(number) + " " + thing + (number == 1 ? "" : "s");
}

// No instruction ends within a character.
std::string cut(std::string_view text) {
  if (text.size() <= kLongest) return std::string(text);
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "...";
}

std::string of_task(const sema::Task& task) {
  std::string text = "\"" + cut(task.prompt) + "\", " + starts_text(task);
  const std::string axes = axes_text(task);
  return axes.empty() ? text : text + ", " + axes;
}

std::uint64_t episodes_of(const sema::Model& model, const sema::Suite& suite) {
  std::uint64_t episodes = 0;
  for (const sema::TaskId id : suite.members)
    episodes += suite.starts_of(id, model.tasks[id]).size();
  return episodes;
}

bool is_whole(const sema::Task& task) { return !task.abstract && task.complete; }

// Where the declaration of a name ends; the name's own end when it is not in the index.
std::uint32_t end_of(const Snapshot& snapshot, const Span& name) {
  const Place* place = snapshot.index().at(name.file, name.begin);
  return place != nullptr && place->declares && !place->whole.is_none() ? place->whole.end
                                                                       : name.end;
}

}  // namespace

std::string axes_text(const sema::Task& task) {
  if (task.baseline == sema::TaskId::kNone) return {};
  std::string text;
  for (const plan::AxisInfo& axis : plan::kAxisTable) {
    if ((task.axes & static_cast<std::uint32_t>(axis.axis)) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(axis.name);
  }
  return text.empty() ? "moves no axis" : text;
}

std::string starts_text(const sema::Task& task) { return counted(task.starts.size(), "start"); }

std::vector<Hint> hints(const Snapshot& snapshot, FileId file, std::uint32_t begin,
                        std::uint32_t end) {
  std::vector<Hint> out;
  const sema::Model& model = snapshot.model();
  const auto add = [&](std::uint32_t offset, std::string label) {
    if (offset >= begin && offset <= end) out.push_back({offset, std::move(label)});
  };
  struct Derived {
    std::uint64_t tasks = 0, starts = 0;
  };
  std::map<Span, Derived> derived;  // by the text of the derive
  for (const sema::Task& task : model.tasks) {
    if (!(task.span.file == file) || !is_whole(task)) continue;
    if (!task.derived) {
      add(end_of(snapshot, task.span), of_task(task));
      continue;
    }
    Derived& all = derived[task.decl_span];
    ++all.tasks;
    all.starts += task.starts.size();
  }
  for (const auto& [span, all] : derived)
    add(span.end, counted(all.tasks, "task") + ", " + counted(all.starts, "start"));
  for (const sema::TaskSet& set : model.sets) {
    if (set.span.file == file && !set.broken)
      add(end_of(snapshot, set.span), counted(set.members.size(), "task"));
  }
  for (const sema::Suite& suite : model.suites) {
    if (!(suite.span.file == file) || suite.broken) continue;
    add(end_of(snapshot, suite.span), counted(suite.members.size(), "task") + ", " +
                                          counted(episodes_of(model, suite), "episode"));
  }
  // `roll 90deg, yaw 90deg` is two turns, and reads as one.
  const auto turns = [&](const auto& statement) {
    if (statement.poses.size() > 1)
      add(statement.span.end, counted(statement.poses.size(), "turn") + ", one a start");
  };
  if (const syntax::ParseResult* tree = snapshot.tree(file)) {
    for (const syntax::Decl& decl : tree->file.decls) {
      const auto in = [&](const auto& body) {
        for (const auto& statement : body) {
          std::visit(
              [&](const auto& one) {
                if constexpr (requires { one.poses.size(); one.span.end; }) turns(one);
              },
              statement);
        }
      };
      if (const auto* object = std::get_if<syntax::ObjectDecl>(&decl.node)) in(object->body);
      if (const auto* layout = std::get_if<syntax::LayoutDecl>(&decl.node)) in(layout->body);
    }
  }
  std::ranges::stable_sort(out, {}, &Hint::offset);
  return out;
}

std::vector<Lens> lenses(const Snapshot& snapshot, FileId file) {
  std::vector<Lens> out;
  const sema::Model& model = snapshot.model();
  for (const sema::Task& task : model.tasks) {
    if (!(task.span.file == file) || !is_whole(task) || task.derived) continue;
    out.push_back({task.span, LensKind::kTask, task.name, starts_text(task)});
  }
  for (const sema::Suite& suite : model.suites) {
    if (!(suite.span.file == file) || suite.broken) continue;
    out.push_back({suite.span, LensKind::kSuite, suite.name,
                   counted(suite.members.size(), "task") + ", " +
                       counted(episodes_of(model, suite), "episode")});
  }
  std::ranges::stable_sort(out, {}, [](const Lens& lens) { return lens.name.begin; });
  return out;
}

}  // namespace probe::language
