#include "runtime/inspect/fixture_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/plan/fixtures.h"
#include "runtime/plan/regions.h"

namespace probe::inspect {
namespace {

// Centimetres or degrees, to a tenth, without a negative zero.
double shown(const Json& moves, const Json& position) {
  const double scale = moves.get<std::string>() == "slides" ? 100 : 180 / std::numbers::pi;
  return std::nearbyint(position.get<double>() * scale * 10) / 10 + 0.0;
}
double shown(const Json& joint, const char* key) { return shown(joint["moves"], joint[key]); }

const char* unit_of(const Json& joint) {
  return joint["moves"].get<std::string>() == "slides" ? "cm" : "deg";
}

// "4 cm"; "4 to 14 cm" where starts differ in it.
std::string start_text(const Json& joint) {
  if (!joint.contains("starts")) return fmt::format("{} {}", shown(joint, "start"), unit_of(joint));
  return fmt::format("{} to {} {}", shown(joint["moves"], joint["starts"]["least"]),
                     shown(joint["moves"], joint["starts"]["most"]), unit_of(joint));
}

Json each_of(const std::vector<std::vector<double>>& starts, std::size_t joint) {
  Json each = Json::array();
  for (const std::vector<double>& joints : starts) each.push_back(joints[joint]);
  return each;
}

// Where a link begins to be seen, in the unit of the joint that decides it.
std::string limit_text(const Json& fixture, const Json& link) {
  for (const Json& joint : fixture["joints"]) {
    if (joint["joint"] == link["joint"])
      return fmt::format("{} {}", shown(joint["moves"], link["at"]), unit_of(joint));
  }
  return "";
}

}  // namespace

Json fixtures_of(const plan::Plan& plan, std::uint32_t index) {
  const plan::TaskRecord& task = plan.tasks()[index];
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const std::vector<double> starts =
      plan::joint_starts_of(plan.tables(), scene, plan.episodes(task)[0]);
  // A table of starts may begin each elsewhere.
  std::vector<double> least = starts, most = starts;
  std::vector<std::vector<double>> all_starts;
  for (const plan::EpisodeRecord& episode : plan.episodes(task)) {
    const std::vector<double>& here =
        all_starts.emplace_back(plan::joint_starts_of(plan.tables(), scene, episode));
    for (std::size_t i = 0; i < here.size(); ++i) {
      least[i] = std::min(least[i], here[i]);
      most[i] = std::max(most[i], here[i]);
    }
  }
  std::size_t next = 0;
  Json all = Json::array();
  for (const std::uint32_t number : plan.fixtures(scene)) {
    const plan::FixtureRecord& fixture = plan.fixtures()[number];
    Json json;
    json["fixture"] = plan.text(fixture.name);
    json["urdf"] = plan.text(plan.assets()[fixture.urdf].path);
    json["joints"] = Json::array();
    const auto armatures = plan.armatures(fixture);
    for (const plan::FixtureJointRecord& joint : plan.joints(fixture)) {
      json["joints"].push_back({{"joint", plan.text(joint.joint)},
                                {"moves", plan::slides(joint) ? "slides" : "turns"},
                                {"endless", plan::is_endless(joint)},
                                {"lower", joint.lower},
                                {"upper", joint.upper},
                                {"start", starts[next]},
                                {"friction", joint.friction},
                                {"damping", joint.damping},
                                {"stiffness", joint.stiffness},
                                {"rest", joint.rest}});
      if (!armatures.empty())
        json["joints"].back()["armature"] = armatures[json["joints"].size() - 1];
      if (least[next] < most[next])
        json["joints"].back()["starts"] = {
            {"least", least[next]}, {"most", most[next]}, {"each", each_of(all_starts, next)}};
      ++next;
    }
    json["parts"] = Json::array();
    for (const plan::PartRecord& part : plan.parts(fixture)) {
      if (part.declared == 0) continue;
      json["parts"].push_back(
          {{"part", plan.text(part.name)},
           {"name", part.text.length == 0 ? Json() : Json(plan.text(part.text))},
           {"joint", part.joint == plan::kNone
                         ? Json()
                         : Json(plan.text(plan.joints(fixture)[part.joint].joint))}});
    }
    for (const plan::ShownRecord& shown : plan.shown(fixture)) {
      const bool above = shown.side == static_cast<std::uint32_t>(plan::ShownSide::kAbove);
      json["shown"].push_back({{"link", plan.text(shown.link)},
                               {"joint", plan.text(plan.joints(fixture)[shown.joint].joint)},
                               {"when", above ? ">=" : "<="},
                               {"at", shown.at}});
    }
    all.push_back(std::move(json));
  }
  return all;
}

Json regions_of(const plan::Plan& plan, std::uint32_t index) {
  const plan::TaskRecord& task = plan.tasks()[index];
  Json all = Json::array();
  for (std::uint32_t number = 0; number < plan.regions().size(); ++number) {
    const plan::RegionRecord& region = plan.regions()[number];
    if (!plan::has_region(plan.tables(), task, region)) continue;
    Json low = Json::array(), high = Json::array();
    for (const double x : region.low) low.push_back(x);
    for (const double x : region.high) high.push_back(x);
    all.push_back({{"region", plan.text(region.name)}, {"low_m", low}, {"high_m", high}});
    // Of a turned one these two are the box around it.
    if (const auto turned = plan::turned_box(plan.tables(), number))
      all.back()["turned"] = {{"middle_m", turned->middle},
                              {"half_m", turned->half},
                              {"rotation_wxyz", turned->rotation}};
  }
  return all;
}

Json names_of(const Json& regions) {
  Json names = Json::array();
  for (const Json& region : regions) names.push_back(region["region"]);
  return names;
}

std::vector<BegunColumn> begun_columns(const Json& fixtures) {
  std::vector<BegunColumn> columns;
  for (const Json& fixture : fixtures) {
    for (const Json& joint : fixture["joints"]) {
      if (!joint.contains("starts")) continue;
      BegunColumn column{fixture["fixture"].text() + "." + joint["joint"].text(), {}};
      for (const Json& at : joint["starts"]["each"])
        column.starts.push_back(fmt::format("{}{}", shown(joint["moves"], at), unit_of(joint)));
      columns.push_back(std::move(column));
    }
  }
  return columns;
}

Json joint_starts_text(const Json& fixtures) {
  Json texts = Json::array();
  for (const Json& fixture : fixtures) {
    for (const Json& joint : fixture["joints"]) {
      texts.push_back(fmt::format("{}.{} {}", fixture["fixture"].get<std::string>(),
                                  joint["joint"].get<std::string>(), start_text(joint)));
    }
  }
  return texts;
}

std::vector<std::string> fixture_lines(const Json& task) {
  std::vector<std::string> lines;
  if (!task.contains("fixtures")) return lines;
  for (const Json& fixture : task["fixtures"]) {
    std::string text = fixture["fixture"].get<std::string>();
    const char* before = ": ";
    for (const Json& joint : fixture["joints"]) {
      text += before + joint["joint"].get<std::string>() + " " + joint["moves"].get<std::string>();
      text += joint["endless"].get<bool>() ? std::string(" without end")
                                           : fmt::format(" {} .. {} {}", shown(joint, "lower"),
                                                         shown(joint, "upper"), unit_of(joint));
      text += ", starts at " + start_text(joint);
      before = "; ";
    }
    std::string parts;
    for (const Json& part : fixture["parts"])
      parts += (parts.empty() ? "" : ", ") + part["part"].get<std::string>();
    if (!parts.empty()) text += before + ("parts " + parts);
    if (fixture.contains("shown")) {
      for (const Json& link : fixture["shown"])
        text += fmt::format("; {} seen while {} {} {}", link["link"].get<std::string>(),
                            link["joint"].get<std::string>(), link["when"].get<std::string>(),
                            limit_text(fixture, link));
    }
    lines.push_back(std::move(text));
  }
  return lines;
}

}  // namespace probe::inspect
