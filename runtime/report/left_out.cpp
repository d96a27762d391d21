#include "runtime/report/left_out.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "runtime/base/file.h"
#include "runtime/base/paths.h"

namespace probe::report {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{256} << 20;

// Paths of the rounds, in order.
std::vector<std::string> rounds_of(const std::string& folder) {
  const std::string rounds = (fs::path(folder) / "rounds").string();
  std::vector<std::string> out;
  const auto names = list_folder(rounds);
  if (!names) return out;
  for (const std::string& name : *names) {
    const std::string round = (fs::path(rounds) / name).string();
    if (is_file((fs::path(round) / "points.csv").string())) out.push_back(round);
  }
  return out;
}

// `P0501` of "P0501: `carrot` and `plate` overlap"; what has no code is its own first words.
std::string code_of(const std::string& why) {
  const std::size_t colon = why.find(':');
  const bool is_code = colon != why.npos && colon <= 6 && why.starts_with('P');
  return is_code ? why.substr(0, colon) : "";
}

}  // namespace

std::vector<std::vector<std::string>> csv_rows(std::string_view text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool quoted = false;
  const auto end_row = [&] {
    if (row.size() > 1 || !row[0].empty()) rows.push_back(std::move(row));
    row.assign(1, "");
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      row.back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      row.emplace_back();
    } else if (c == '\n' && !quoted) {
      end_row();
    } else if (c != '\r' || quoted) {
      row.back() += c;
    }
  }
  end_row();
  return rows;
}

void read_left_out(const std::string& folder, std::vector<LeftOutReason>& reasons,
                   std::vector<std::string>& notes) {
  std::set<std::string> seen;
  for (const std::string& round : rounds_of(folder)) {
    const std::string path = (fs::path(round) / "points.csv").string();
    const auto text = read_file(path, {.most = kMostBytes});
    if (!text) {
      notes.push_back(to_text(text.failure()));
      continue;
    }
    const auto rows = csv_rows(*text);
    if (rows.empty() || rows[0].size() < 3 || rows[0].back() != "left_out") {
      notes.push_back(path + ": it is no table of points");
      continue;
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const std::vector<std::string>& row = rows[i];
      if (row.size() != rows[0].size() || row.back().empty()) continue;
      if (row[0].ends_with("_placed") || !seen.insert(row[0]).second) continue;
      const std::string code = code_of(row.back());
      auto at = std::ranges::find(reasons, code, &LeftOutReason::code);
      if (at == reasons.end()) at = reasons.insert(reasons.end(), {code, row.back(), 0, 0});
      const bool is_whole = row[row.size() - 2] == "0";
      ++(is_whole ? at->points : at->in_part);
    }
  }
  std::ranges::stable_sort(reasons, [](const LeftOutReason& a, const LeftOutReason& b) {
    return a.points + a.in_part > b.points + b.in_part;
  });
}

std::string round_with(const std::string& folder, const std::string& point) {
  std::vector<std::string> rounds = rounds_of(folder);
  std::ranges::reverse(rounds);
  for (const std::string& round : rounds) {
    const auto text = read_file((fs::path(round) / "points.csv").string(), {.most = kMostBytes});
    if (!text) continue;
    for (const auto& row : csv_rows(*text)) {
      if (row[0] == point) return round;
    }
  }
  return "";
}

}  // namespace probe::report
