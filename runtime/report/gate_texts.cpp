// A gate as text, Markdown, JUnit's XML and JSON.
#include <fmt/format.h>

#include "runtime/base/percent.h"
#include "runtime/base/xml_text.h"
#include "runtime/report/gate.h"

namespace probe::report {
namespace {

std::string points(double share) { return decimal_text(100 * share, 1); }

std::string rate(std::int64_t k, const GateRow& row) {
  return percent_text(k, row.episodes) + " %";
}

// "a drop of 3.0 points (at least 1.2, at most 4.9)", as said of success.
std::string change(const Gate& gate, const GateRow& row) {
  const bool is_drop = (row.drop >= 0) != gate.lower_is_better;
  return fmt::format("a {} of {} points (as worse counts: at least {}, at most {})",
                     is_drop ? "drop" : "rise", points(std::abs(row.drop)),
                     signed_text(100 * row.low, 1), signed_text(100 * row.high, 1));
}

std::string allowed(const Gate& gate) {
  return fmt::format("{} points", points(gate.options.allow));
}

std::string meaning(const Gate& gate, const GateRow& row) {
  switch (row.verdict) {
    case Verdict::kWorse: return "the data show that it is worse by more than " + allowed(gate);
    case Verdict::kNotWorse: return "the data show that it is not worse by more than " + allowed(gate);
    case Verdict::kUndecided: break;
  }
  return "the data do not show whether it is worse by more than " + allowed(gate);
}

std::string sentence(const Gate& gate, const GateRow& row) {
  return fmt::format("{} {} against {} in the same {} episodes ({} starts): {}; {}",
                     gate.options.metric, rate(row.now, row), rate(row.before, row), row.episodes,
                     row.starts, change(gate, row), meaning(gate, row));
}

std::string sure(const Gate& gate) {
  return fmt::format("Each bound holds with {} %, whenever one looks; an allowed change is called "
                     "worse with chance at most {} %.",
                     points(1 - gate.options.error), points(gate.options.error));
}

std::string in_cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '\\' || c == '`' || c == '<' || c == '*' || c == '_') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

}  // namespace

std::string to_text(const Gate& gate) {
  std::string out = fmt::format("{} against {}\n", gate.now, gate.before);
  for (const GateRow& row : gate.rows)
    out += fmt::format("{:<10} {}: {}\n", to_text(row.verdict), row.name, sentence(gate, row));
  out += sure(gate) + "\n";
  for (const std::string& note : gate.notes) out += "note: " + note + "\n";
  return out;
}

std::string to_markdown(const Gate& gate) {
  std::string out = fmt::format(
      "### {}: {} against {}\n\n| | verdict | {} | before | worse by (points) | at least | at most | "
      "episodes |\n|---|---|---|---|---|---|---|---|\n",
      gate.is_worse() ? "Worse" : gate.is_decided() ? "Not worse" : "Not shown to be worse",
      in_cell(gate.now), in_cell(gate.before), in_cell(gate.options.metric));
  for (const GateRow& row : gate.rows) {
    out += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", in_cell(row.name),
                       to_text(row.verdict), rate(row.now, row), rate(row.before, row),
                       signed_text(100 * row.drop, 1), signed_text(100 * row.low, 1),
                       signed_text(100 * row.high, 1), row.episodes);
  }
  out += fmt::format("\nAllowed: {}. {}\n", allowed(gate), sure(gate));
  for (const std::string& note : gate.notes) out += "\n- " + in_cell(note) + "\n";
  return out;
}

std::string to_junit(const Gate& gate) {
  std::size_t failures = 0;
  for (const GateRow& row : gate.rows) failures += row.verdict == Verdict::kWorse ? 1 : 0;
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"vlaprobe gate\" "
      "tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\">\n",
      gate.rows.size(), failures);
  for (const GateRow& row : gate.rows) {
    const std::string said = xml_text(sentence(gate, row));
    out += fmt::format("    <testcase classname=\"{} against {}\" name=\"{}: {}\">\n", xml_text(gate.now),
                       xml_text(gate.before), xml_text(gate.options.metric), xml_text(row.name));
    if (row.verdict == Verdict::kWorse) {
      out += fmt::format("      <failure message=\"{}\">{}</failure>\n", said, said);
    } else {
      out += fmt::format("      <system-out>{}</system-out>\n", said);
    }
    out += "    </testcase>\n";
  }
  std::string notes = sure(gate);
  for (const std::string& note : gate.notes) notes += "\n" + note;
  return out + "    <system-out>" + xml_text(notes) + "</system-out>\n  </testsuite>\n</testsuites>\n";
}

Json to_json(const Gate& gate) {
  Json rows = Json::array();
  for (const GateRow& row : gate.rows) {
    rows.push_back({{"name", row.name},
                    {"verdict", to_text(row.verdict)},
                    {"starts", row.starts},
                    {"episodes", row.episodes},
                    {"now", row.now},
                    {"before", row.before},
                    {"worse_by", row.drop},
                    {"at_least", row.low},
                    {"at_most", row.high},
                    {"p", row.p}});
  }
  return {{"now", gate.now},
          {"before", gate.before},
          {"metric", gate.options.metric},
          {"allow", gate.options.allow},
          {"error", gate.options.error},
          {"worse", gate.is_worse()},
          {"decided", gate.is_decided()},
          {"rows", std::move(rows)},
          {"notes", gate.notes}};
}

}  // namespace probe::report
