#include "runtime/search/points_file.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "compiler/diag/text.h"
#include "runtime/base/csv.h"
#include "runtime/base/file.h"
#include "runtime/base/paths.h"
#include "runtime/compile/files.h"
#include "runtime/search/proofs.h"
#include "runtime/search/stored_points.h"

namespace probe::search {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "points.probe";

// A suite's name that the text has not.
std::string free_suite(const BaseTask& base, const char* what) {
  std::string name = base.space().name + "_" + what;
  const auto is_taken = [&] {
    return std::ranges::any_of(base.model().suites,
                               [&](const sema::Suite& suite) { return suite.name == name; });
  };
  while (is_taken()) name += "_";
  return name;
}

// A text of several points, and which lines are whose.
struct Pages {
  std::string file, text;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> lines;  // by point, from 1, both included
  std::map<std::string, std::size_t> tables;                   // file to point

  // Whose lines or table it lies in; nothing elsewhere.
  std::optional<std::size_t> point_at(const SourceSet& sources, const Span& span) const;
};

class Page {
 public:
  Page(const BaseTask& base, std::string folder) : base_(base), folder_(std::move(folder)) {
    pages_.text = "# Points of the space `" + base.space().name + "`, each as a variant.\nuse \"" +
                  use_of(base.options().file, folder_) + "\"\n\n";
    line_ = 4;
  }

  // The point's lines and its table; false, with the reason in `written`, where it has none.
  Result<bool> add(std::size_t index, const space::Point& point, space::WrittenPoint& written,
                   bool allowed, const std::string& remark = {}) {
    written = space::write_point(base_.model(), base_.space(), point, allowed, base_.ways());
    if (!written.left_out.empty()) return false;
    if (pages_.lines.size() <= index) pages_.lines.resize(index + 1);
    std::string text = remark;
    text += written.text;
    const auto count = static_cast<std::uint32_t>(std::ranges::count(text, '\n'));
    pages_.lines[index] = {line_, line_ + count - 1};
    line_ += count;
    pages_.text += text;
    names_.push_back(point.name);
    if (written.table) {
      const std::string table = (fs::path(folder_) / written.table->file).string();
      PROBE_TRY(write_file(table, std::as_bytes(std::span(written.table->text))));
      pages_.tables[table] = index;
    }
    return true;
  }

  Result<Pages> finish(const std::string& suite, const std::string& file) {
    pages_.text += "\nsuite " + suite + " { tasks { " + base_.task().name;
    for (const std::string& name : names_) pages_.text += ", " + name;
    pages_.text += " }; seeds 0 }\n";
    pages_.file = (fs::path(folder_) / file).string();
    PROBE_TRY(write_file(pages_.file, std::as_bytes(std::span(pages_.text))));
    return pages_;
  }

 private:
  const BaseTask& base_;
  std::string folder_;
  Pages pages_;
  std::uint32_t line_ = 1;
  std::vector<std::string> names_;
};

// Whether a source is the file at `path`, and not one of that name elsewhere.
bool is_file_at(const SourceFile& source, const std::string& path) {
  return absolute_path(source.name()) == absolute_path(path) || is_same(source.name(), path);
}

std::optional<std::size_t> Pages::point_at(const SourceSet& sources, const Span& span) const {
  if (span.is_none()) return std::nullopt;
  const SourceFile& source = sources.file(span.file);
  if (is_file_at(source, file)) {
    const std::uint32_t line = source.line_of(span.begin);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (line >= lines[i].first && line <= lines[i].second) return i;
    }
    return std::nullopt;
  }
  const auto table =
      tables.find((fs::path(file).parent_path() / fs::path(source.name()).filename()).string());
  if (table == tables.end() || !is_file_at(source, table->first)) return std::nullopt;
  return table->second;
}

// Which points are to blame, with what is said of each first.
std::map<std::size_t, std::string> blamed(const Compilation& compilation, const Pages& pages,
                                          bool wants_seen) {
  std::map<std::size_t, std::string> out;
  const auto point_at = [&](const Span& span) { return pages.point_at(compilation.sources, span); };
  for (const Diagnostic& said : compilation.diagnostics.items()) {
    // What is out of the picture is no fair start either.
    if (said.severity != Severity::kError && (said.code != Code::P0505 || !wants_seen)) continue;
    std::optional<std::size_t> point = point_at(said.primary);
    for (std::size_t i = 0; i < said.labels.size() && !point; ++i)
      point = point_at(said.labels[i].span);
    if (point) out.try_emplace(*point, std::string(info(said.code).text) + ": " + said.message);
  }
  return out;
}

class Planner {
 public:
  Planner(const BaseTask& base, std::string folder) : base_(base), folder_(std::move(folder)) {}

  Result<PlannedPoints> plan(std::vector<PlannedPoint> planned) {
    std::vector<bool> alive(planned.size(), true);
    while (true) {
      PROBE_ASSIGN(Attempt attempt, compile(planned, alive, kFile, true));
      if (attempt.compilation.ok && attempt.blamed.empty())
        return finish(std::move(planned), std::move(attempt));
      if (attempt.blamed.empty())
        return Failure{
            Fault::kUsage,
            "the points of space `" + base_.space().name + "` do not compile:\n" +
                render_text(attempt.compilation.diagnostics, attempt.compilation.sources),
            (fs::path(folder_) / kFile).string()};
      PROBE_TRY(sort_out(attempt.blamed, planned, alive));
    }
  }

 private:
  struct Attempt {
    Compilation compilation;
    std::map<std::size_t, std::string> blamed;
  };

  Result<Attempt> compile(std::vector<PlannedPoint>& planned, std::vector<bool>& alive,
                          const std::string& file, bool wants_plan) {
    Page page(base_, folder_);
    for (std::size_t i = 0; i < planned.size(); ++i) {
      if (!alive[i]) continue;
      space::WrittenPoint written;
      PROBE_ASSIGN(const bool is_there, page.add(i, planned[i].point, written, false));
      alive[i] = is_there;
      planned[i].starts = written.starts;
      if (!is_there) planned[i].why = written.left_out;
    }
    const std::string suite = free_suite(base_, "points");
    PROBE_ASSIGN(const Pages pages, page.finish(suite, file));
    PROBE_ASSIGN(Compilation compilation,
                 compile::compile_files({pages.file}, {.assets = base_.options().assets,
                                                       .library = base_.options().library,
                                                       .suite = suite,
                                                       .wants_plan = wants_plan}));
    auto to_blame = blamed(compilation, pages, base_.is_seen());
    return Attempt{std::move(compilation), std::move(to_blame)};
  }

  // What the compiler refuses is left out; of a point that moves things only the starts that it
  // refuses.
  Status sort_out(const std::map<std::size_t, std::string>& to_blame,
                  std::vector<PlannedPoint>& planned, std::vector<bool>& alive) {
    std::vector<PlannedPoint> single;  // a start each
    std::vector<std::size_t> of;
    for (const auto& [i, why] : to_blame) {
      planned[i].why = why;
      // A start may be out of reach, or out of a moved camera's picture.
      const bool moves = std::ranges::any_of(
          space::changed_axes(base_.space(), planned[i].point.values), [&](std::size_t axis) {
            const sema::SpaceAxisKind kind = base_.space().axes[axis].kind;
            return sema::info_of(kind).moves_things || kind == sema::SpaceAxisKind::kCameraX ||
                   kind == sema::SpaceAxisKind::kCameraY || kind == sema::SpaceAxisKind::kCameraZ ||
                   kind == sema::SpaceAxisKind::kCameraTurn;
          });
      if (!moves || planned[i].starts.size() < 2) {
        alive[i] = false;
        continue;
      }
      for (const std::uint32_t start : planned[i].starts) {
        PlannedPoint one = planned[i];
        one.point.name += "_s" + std::to_string(start);
        one.point.starts = {start};
        single.push_back(std::move(one));
        of.push_back(i);
      }
      planned[i].point.starts.clear();
    }
    std::vector<bool> is_fair(single.size(), true);
    while (!single.empty()) {
      PROBE_ASSIGN(const Attempt attempt, compile(single, is_fair, "starts.probe", false));
      if (attempt.blamed.empty()) break;
      for (const auto& [k, why] : attempt.blamed) is_fair[k] = false;
    }
    // Where no single start is to blame it is the whole point.
    std::set<std::size_t> refused;
    for (std::size_t k = 0; k < single.size(); ++k) {
      if (!is_fair[k]) refused.insert(of[k]);
    }
    for (std::size_t k = 0; k < single.size(); ++k) {
      if (is_fair[k] && refused.contains(of[k]))
        planned[of[k]].point.starts.push_back(single[k].point.starts.front());
    }
    for (const std::size_t i : std::set(of.begin(), of.end()))
      alive[i] = !planned[i].point.starts.empty();
    for (std::size_t k = 0; k < single.size(); ++k) {
      std::error_code ignored;
      fs::remove(fs::path(folder_) / (single[k].point.name + ".csv"), ignored);
    }
    std::error_code ignored;
    fs::remove(fs::path(folder_) / "starts.probe", ignored);
    return {};
  }

  Result<PlannedPoints> finish(std::vector<PlannedPoint> planned, Attempt attempt) {
    PROBE_ASSIGN(plan::Plan plan, plan::Plan::from_bytes(std::move(attempt.compilation.plan)));
    PlannedPoints out{std::move(plan), 0, std::move(planned), attempt.compilation.asset_root};
    const auto index_of = [&](const std::string& name) { return out.plan.find_task(name); };
    const auto base = index_of(base_.task().name);
    if (!base) return Failure{Fault::kInternal, "the plan lacks the base task", folder_};
    out.base_task = *base;
    std::string table = "task";
    for (const sema::SpaceAxis& axis : base_.space().axes) table += "," + csv_cell(axis.name);
    table += ",starts,left_out\n";
    for (PlannedPoint& one : out.points) {
      one.task = index_of(one.point.name);
      if (!one.task) one.starts.clear();
      table += one.point.name;
      for (std::size_t i = 0; i < one.point.values.size(); ++i)
        table += "," + csv_cell(space::value_text(base_.space().axes[i], one.point.values[i]));
      table += "," + std::to_string(one.starts.size()) + "," + csv_cell(one.why) + "\n";
    }
    PROBE_TRY(
        write_file((fs::path(folder_) / "points.csv").string(), std::as_bytes(std::span(table))));
    return out;
  }

  const BaseTask& base_;
  std::string folder_;
};

}  // namespace

std::string use_of(const std::string& file, const std::string& folder) {
  const std::string whole = absolute_path(file);
  const fs::path from = fs::path(absolute_path(folder));
  std::string written = fs::path(whole).lexically_relative(from).generic_string();
  if (written.empty() || !is_same((from / written).string(), whole)) written = whole;
  std::string text;
  for (const char c : written) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text;
}

Result<PlannedPoints> plan_points(const BaseTask& base, std::vector<space::Point> points,
                                  StoredPoints& stored, const std::string& folder) {
  PROBE_TRY(make_lasting_folders(folder));
  const std::vector<PlannedPoint> asked = with_proofs(base.space(), std::move(points));
  if (auto known = stored.find(asked, folder)) return std::move(*known);
  PROBE_ASSIGN(PlannedPoints planned, Planner(base, folder).plan(asked));
  PROBE_TRY(stored.keep(asked, planned, folder));
  return planned;
}

Status write_found(const BaseTask& base, const std::vector<KeptPoint>& kept,
                   const std::string& file) {
  const std::string folder = fs::path(file).parent_path().string();
  const std::string name = fs::path(file).filename().string();
  // Twice: what is confounded is known when it was looked at.
  std::set<std::size_t> allowed;
  for (int round = 0; round < 2; ++round) {
    Page page(base, folder);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      space::WrittenPoint written;
      PROBE_ASSIGN(
          [[maybe_unused]] const bool is_there,
          page.add(i, kept[i].point, written, allowed.contains(i), "# " + kept[i].remark + "\n"));
    }
    PROBE_ASSIGN(const Pages pages, page.finish(free_suite(base, "found"), name));
    if (round == 1) break;
    PROBE_ASSIGN(const Compilation compilation,
                 compile::compile_files({file}, {.assets = base.options().assets,
                                                 .library = base.options().library,
                                                 .wants_plan = false}));
    for (const Diagnostic& said : compilation.diagnostics.items()) {
      if (said.code != Code::P0701) continue;
      const auto point = pages.point_at(compilation.sources, said.primary);
      if (point) allowed.insert(*point);
    }
  }
  return {};
}

}  // namespace probe::search
