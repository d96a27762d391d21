#include "runtime/report/compare_searches.h"

#include <fmt/format.h>

#include <algorithm>

namespace probe::report {
namespace {

stats::Interval tolerance_ends(const Tolerance& side) {
  return {std::min(*side.near, *side.far), std::max(*side.near, *side.far)};
}

std::string verdict_of(const std::optional<Tolerance>& a, const std::optional<Tolerance>& b) {
  if (!a || !b) return "searched once";
  if (a->is_found() && b->is_found()) {
    const stats::Interval x = tolerance_ends(*a), y = tolerance_ends(*b);
    const bool overlap = x.low <= y.high && y.low <= x.high;
    return overlap ? "intervals overlap" : "intervals do not overlap";
  }
  if (a->status == "no fall" && b->status == "no fall") return "both stand it";
  if ((a->is_found() && b->status == "no fall") || (b->is_found() && a->status == "no fall"))
    return "a tolerance was found in one alone";
  return "not both have a tolerance";
}

std::string side_words(const std::optional<Tolerance>& side) {
  if (!side) return "not searched";
  return side->in_words() + (side->is_found() ? " (" + side->interval() + ")" : "");
}

Json side_json(const std::optional<Tolerance>& side) {
  if (!side) return nullptr;
  Json out = {{"status", side->status},   {"unit", side->unit},           {"own", side->own},
              {"end", side->end},         {"last_fair", side->last_fair}, {"trials", side->trials},
              {"words", side_words(side)}};
  if (side->near && side->far) {
    out["tolerance"] = *side->at;
    const stats::Interval range = tolerance_ends(*side);
    out["interval"] = Json::array({range.low, range.high});
  }
  return out;
}

Failure of_another(const SearchFindings& a, const SearchFindings& b, const std::string& what,
                   const std::string& of_a, const std::string& of_b) {
  return {Fault::kUsage,
          fmt::format("`{}` and `{}` were searched over another {} (`{}`, `{}`): tolerances are "
                      "compared of one",
                      a.folder, b.folder, what, of_a, of_b),
          ""};
}

const Tolerance* like_side(const SearchFindings& in, const Tolerance& like) {
  const auto at = std::ranges::find_if(in.sides, [&](const Tolerance& side) {
    return side.axis == like.axis && side.up == like.up;
  });
  return at == in.sides.end() ? nullptr : &*at;
}

}  // namespace

Result<ComparedSearches> compare_searches(const std::string& a, const std::string& b) {
  ComparedSearches out;
  PROBE_ASSIGN(out.a, read_findings(a));
  PROBE_ASSIGN(out.b, read_findings(b));
  for (const SearchFindings* one : {&out.a, &out.b}) {
    if (one->method != "boundary")
      return Failure{Fault::kUsage,
                     "it is a `search " + one->method +
                         "`: of two searches boundaries are compared; `report` shows any beside "
                         "one another",
                     one->folder};
    if (one->sides.empty())
      return Failure{Fault::kUsage, "its search has found nothing yet: it is not done",
                     one->folder};
  }
  if (out.a.space != out.b.space)
    return of_another(out.a, out.b, "space", out.a.space, out.b.space);
  if (out.a.task != out.b.task) return of_another(out.a, out.b, "task", out.a.task, out.b.task);
  if (out.a.text_sha256 != out.b.text_sha256)
    return of_another(out.a, out.b, "text", out.a.text_sha256.substr(0, 16),
                      out.b.text_sha256.substr(0, 16));
  for (const Tolerance& side : out.a.sides) {
    const Tolerance* const other = like_side(out.b, side);
    out.sides.push_back({side, other == nullptr ? std::nullopt : std::optional(*other), ""});
  }
  for (const Tolerance& side : out.b.sides) {
    if (like_side(out.a, side) == nullptr) out.sides.push_back({std::nullopt, side, ""});
  }
  for (ComparedSide& side : out.sides) side.verdict = verdict_of(side.a, side.b);
  return out;
}

std::string to_text(const ComparedSearches& compared) {
  const SearchFindings &a = compared.a, &b = compared.b;
  std::string out = fmt::format("tolerances in space {} of {}\n  A  {} ({})\n  B  {} ({})\n",
                                a.space, a.task, a.policy, a.folder, b.policy, b.folder);
  if (a.proved != b.proved)
    out += "one of the two asked the expert what can be done, the other did not\n";
  for (const ComparedSide& side : compared.sides) {
    out += fmt::format("\n{}: {}\n  A  {}\n  B  {}\n", (side.a ? side.a : side.b)->side,
                       side.verdict, side_words(side.a), side_words(side.b));
  }
  out +=
      "\nintervals are of 95 % each. That two do not overlap is no test at 5 %, and many sides are "
      "looked at\n";
  return out;
}

Json to_json(const ComparedSearches& compared) {
  const auto search = [](const SearchFindings& one) -> Json {
    return {{"folder", one.folder}, {"policy", one.policy},           {"seed", one.seed},
            {"trials", one.trials}, {"proved_by_expert", one.proved}, {"done", one.done}};
  };
  Json sides = Json::array();
  for (const ComparedSide& side : compared.sides) {
    const Tolerance& like = side.a ? *side.a : *side.b;
    sides.push_back({{"side", like.side},
                     {"axis", like.axis},
                     {"up", like.up},
                     {"a", side_json(side.a)},
                     {"b", side_json(side.b)},
                     {"verdict", side.verdict}});
  }
  return {{"format", "vlaprobe-compared-searches"},
          {"version", 1},
          {"space", compared.a.space},
          {"task", compared.a.task},
          {"interval_level", 0.95},
          {"a", search(compared.a)},
          {"b", search(compared.b)},
          {"sides", std::move(sides)}};
}

}  // namespace probe::report
