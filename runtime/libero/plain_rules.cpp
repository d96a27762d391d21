#include "runtime/libero/plain_rules.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "runtime/base/trig.h"

namespace probe::libero {
namespace {

// "0 0.01 0.2" as MJCF has it; what is not said is 0.
Result<Vec3> vector_in(const Json& of, const char* key, const std::string& where) {
  const Json* text = of.find(key);
  if (text == nullptr || text->is_null()) return Vec3(Vec3::Zero());
  PROBE_TRY(member(of, key, JsonKind::kText, where));
  Vec3 out = Vec3::Zero();
  const std::string& words = text->text();
  const char *at = words.data(), *end = at + words.size();
  for (int i = 0; i < 3; ++i) {
    while (at != end && *at == ' ') ++at;
    if (at == end) break;
    const auto [rest, error] = std::from_chars(at, end, out[i]);
    if (error != std::errc() || !std::isfinite(out[i]))
      return Failure{Fault::kUsage, std::string("`") + key + "` has what is no number", where};
    at = rest;
  }
  return out;
}

Result<Quat> turn_in(const Json& of, const std::string& where) {
  const Json* text = of.find("quat");
  if (text == nullptr || text->is_null()) return Quat(Quat::Identity());
  PROBE_TRY(member(of, "quat", JsonKind::kText, where));
  std::array<double, 4> q{};
  const std::string& words = text->text();
  const char *at = words.data(), *end = at + words.size();
  for (double& number : q) {
    while (at != end && *at == ' ') ++at;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !std::isfinite(number))
      return Failure{Fault::kUsage, "`quat` is no four numbers", where};
    at = rest;
  }
  const Quat turn(q[0], q[1], q[2], q[3]);
  if (!(turn.norm() > 1e-6)) return Failure{Fault::kUsage, "`quat` is no turn", where};
  return Quat(turn.normalized());
}

bool is_on(const Vec3& p, const Pose& at, const Vec3& size) {
  // The matrix itself, where its transpose would be right.
  const Vec3 d = at.rotation.toRotationMatrix() * (p - at.position);
  return size.z() - 0.005 < d.z() && d.z() < size.z() + 0.1 && std::abs(d.x()) < size.x() &&
         std::abs(d.y()) < size.y();
}

bool is_in(const Vec3& p, const Pose& at, const Vec3& size) {
  const Vec3 t = (at.rotation.toRotationMatrix() * size).cwiseAbs();
  Vec3 low = at.position - t;
  low.z() -= 0.01;
  return (p.array() > low.array()).all() && (p.array() < (at.position + t).array()).all();
}

// Where the regions of a table or a floor lie (m): their middle's height, and what x counts from.
struct Zone {
  double height = 0.895, x = 0;
};
Zone zone_of(const std::string& problem) {
  const auto is = [&](const char* word) { return problem.find(word) != problem.npos; };
  if (is("Kitchen")) return {0.875, 0};
  if (is("Study")) return {0.867, -0.2};
  if (is("Living")) return {0.41, 0};
  if (is("Floor")) return {0.02, 0};
  return {};
}

}  // namespace

Result<PlainRules::Model> PlainRules::read_model(const Json& classes, const std::string& cls) {
  const std::string where = "libero_object_classes.json, " + cls;
  PROBE_ASSIGN(const Json* said, member(classes, cls, JsonKind::kObject,
                                        "libero_object_classes.json"));
  PROBE_ASSIGN(const Json* bodies, member(*said, "bodies", JsonKind::kArray, where));
  Model model;
  for (const Json& one : *bodies) {
    PROBE_ASSIGN(const Json* name, member(one, "name", JsonKind::kText, where));
    Body body;
    body.name = name->text();
    PROBE_ASSIGN(body.pose.position, vector_in(one, "pos", where));
    PROBE_ASSIGN(body.pose.rotation, turn_in(one, where));
    if (!model.empty()) {
      // Unsaid it is the thing's own.
      const Json* parent = one.find("parent");
      const std::string of = parent != nullptr && parent->is_string() ? parent->text() : "main";
      const auto at = std::ranges::find(model, of, &Body::name);
      if (at == model.end())
        return Failure{Fault::kUsage, "`" + body.name + "` hangs on no body before it", where};
      body.parent = static_cast<int>(at - model.begin());
    }
    PROBE_ASSIGN(const Json* joints, member(one, "joints", JsonKind::kArray, where));
    for (const Json& joint : *joints) {
      PROBE_ASSIGN(const Json* called, member(joint, "name", JsonKind::kText, where));
      PROBE_ASSIGN(const Json* type, member(joint, "type", JsonKind::kText, where));
      body.joints.push_back({called->text(), type->text() == "slide"});
    }
    PROBE_ASSIGN(const Json* sites, member(one, "sites", JsonKind::kArray, where));
    for (const Json& site : *sites) {
      PROBE_ASSIGN(const Json* called, member(site, "name", JsonKind::kText, where));
      Site& made = body.sites.emplace_back();
      made.name = called->text();
      PROBE_ASSIGN(made.pose.position, vector_in(site, "pos", where));
      PROBE_ASSIGN(made.pose.rotation, turn_in(site, where));
      PROBE_ASSIGN(made.size, vector_in(site, "size", where));
    }
    model.push_back(std::move(body));
  }
  if (model.empty()) return Failure{Fault::kUsage, "it has no body", where};
  return model;
}

Status PlainRules::read_region(const RecordedTask& task, const std::string& name) {
  const std::string where = "libero_tasks.json, " + task.key() + ", " + name;
  const Json& said = task.said["regions"][name];
  PROBE_ASSIGN(const Json* target, member(said, "target", JsonKind::kText, where));
  Region region;
  region.site.name = name;
  PROBE_ASSIGN(const Json* workspace, member(task.said, "workspace", JsonKind::kText, where));
  if (target->text() == workspace->text()) {
    PROBE_ASSIGN(const Json* ranges, member(said, "ranges", JsonKind::kArray, where));
    PROBE_ASSIGN(const Json* problem, member(task.said, "problem", JsonKind::kText, where));
    if (ranges->empty()) return Failure{Fault::kUsage, "it has no `ranges`", where};
    PROBE_ASSIGN(const Json* sites, member(task.said, "sites", JsonKind::kObject, where));
    const Json* site = sites->find(name);
    if (site == nullptr) return {};  // a place where things begin, of which no rule asks
    Json first = Json::object();
    first["range"] = ranges->front();
    PROBE_ASSIGN(const std::vector<double> range, numbers(first, "range", 4, where));
    PROBE_ASSIGN(const std::vector<double> size, numbers(*site, "size", 0, where));
    if (size.size() < 2) return Failure{Fault::kUsage, "`size` is no rectangle's", where};
    const Zone zone = zone_of(problem->text());
    region.site.pose.position =
        Vec3((range[0] + range[2]) / 2 + zone.x, (range[1] + range[3]) / 2, zone.height);
    region.site.pose.rotation = Quat::Identity();
    region.site.size = Vec3(size[0], size[1], 0.007);
  } else {
    region.thing = target->text();
    const auto model = models_.find(region.thing);
    const std::string own =
        name.size() > region.thing.size() ? name.substr(region.thing.size() + 1) : "";
    bool found = false;
    for (std::size_t b = 0; model != models_.end() && b < model->second.size(); ++b) {
      for (const Site& site : model->second[b].sites) {
        if (site.name != own || found) continue;
        region.body = b;
        region.site = site;
        found = true;
      }
    }
    if (!found) return {};  // of a thing that is not there, or of a site that is none
  }
  regions_.emplace(name, std::move(region));
  return {};
}

Status PlainRules::check(const Fact& fact, const std::string& where) const {
  const auto fail = [&](const std::string& what) { return Failure{Fault::kUsage, what, where}; };
  if (fact.rule == "on" || fact.rule == "in") {
    if (std::ranges::find(objects_, fact.what) == objects_.end())
      return fail("`" + fact.what + "` is no object");
    const bool is_object = std::ranges::find(objects_, fact.where) != objects_.end();
    if (regions_.contains(fact.where) || (is_object && fact.rule == "on")) return {};
    return fail("`" + fact.where + "` is no region of it");
  }
  static const std::set<std::string> kJointRules = {"open", "close", "turnon", "turnoff"};
  if (!kJointRules.contains(fact.rule)) return fail("`" + fact.rule + "` is no rule");
  const auto region = regions_.find(fact.what);
  if (region == regions_.end() && !models_.contains(fact.what))
    return fail("`" + fact.what + "` is nothing that opens");
  const Model& model = models_.at(region == regions_.end() ? fact.what : region->second.thing);
  const auto moves = [](const Body& body) { return !body.joints.empty(); };
  if (region == regions_.end() ? std::ranges::any_of(model, moves)
                               : moves(model[region->second.body]))
    return {};
  return fail("`" + fact.what + "` has no joint");
}

Result<PlainRules> PlainRules::create(const Json& classes, const RecordedTask& task) {
  PlainRules rules;
  const std::string where = "libero_tasks.json, " + task.key();
  for (const char* kind : {"objects", "fixtures"}) {
    for (const auto& [name, thing] : task.said[kind].items()) {
      PROBE_ASSIGN(const Json* cls, member(thing, "cls", JsonKind::kText, where));
      PROBE_ASSIGN(rules.models_[name], read_model(classes, cls->text()));
      if (std::string_view(kind) == "objects") rules.objects_.push_back(name);
    }
  }
  PROBE_ASSIGN(const Json* regions, member(task.said, "regions", JsonKind::kObject, where));
  for (const auto& [name, region] : regions->items()) PROBE_TRY(rules.read_region(task, name));
  for (const Json& said : task.said["goal"]) {
    Fact fact;
    std::string* const parts[] = {&fact.rule, &fact.what, &fact.where};
    if (!said.is_array() || said.size() < 2 || said.size() > 3 ||
        !std::all_of(said.begin(), said.end(), [](const Json& word) { return word.is_string(); }))
      return Failure{Fault::kUsage, "a fact of its goal is no rule of two or three words", where};
    for (std::size_t i = 0; i < said.size(); ++i) *parts[i] = said[i].text();
    PROBE_TRY(rules.check(fact, where));
    rules.goal_.push_back(std::move(fact));
  }
  return rules;
}

Pose PlainRules::body_pose(const PlainState& state, const std::string& thing,
                           std::size_t body) const {
  if (body == 0) {
    const auto object = state.objects.find(thing);
    return object != state.objects.end() ? object->second : state.fixtures.at(thing);
  }
  const Body& own = models_.at(thing)[body];
  Pose pose = body_pose(state, thing, static_cast<std::size_t>(own.parent)) * own.pose;
  for (const Joint& joint : own.joints) {
    const double q = state.joints.at(thing + "_" + joint.name);
    if (joint.slides) {
      pose.position += pose.rotation * Vec3(0, q, 0);
    } else {
      const SinCos half = portable_sincos(q / 2);
      pose.rotation = pose.rotation * Quat(half.cos, 0, 0, half.sin);
    }
  }
  return pose;
}

PlainRules::Site PlainRules::placed(const PlainState& state, const Region& region) const {
  if (region.thing.empty()) return region.site;
  Site site = region.site;
  site.pose = body_pose(state, region.thing, region.body) * region.site.pose;
  return site;
}

bool PlainRules::holds(const PlainState& state, const Fact& fact, bool touching) const {
  if (fact.rule == "on" || fact.rule == "in") {
    const Vec3 p = state.objects.at(fact.what).position;
    const auto region = regions_.find(fact.where);
    if (region == regions_.end()) {
      const Vec3 other = state.objects.at(fact.where).position;
      return touching && p.z() >= other.z() && (p - other).head<2>().norm() < 0.03;
    }
    const Site site = placed(state, region->second);
    if (region->second.thing.empty() || fact.rule == "in")
      return fact.rule == "in" ? is_in(p, site.pose, site.size) : is_on(p, site.pose, site.size);
    return touching && is_on(p, site.pose, site.size);
  }
  // Open and on where any joint is, closed and off where all are; a drawer has one of its own.
  const auto region = regions_.find(fact.what);
  const std::string& thing = region == regions_.end() ? fact.what : region->second.thing;
  const Model& model = models_.at(thing);
  const bool asks_all = fact.rule == "close" || fact.rule == "turnoff";
  for (std::size_t b = 0; b < model.size(); ++b) {
    if (region != regions_.end() && b != region->second.body) continue;
    for (const Joint& joint : model[b].joints) {
      const double q = state.joints.at(thing + "_" + joint.name);
      const bool is = fact.rule == "open"     ? (joint.slides ? q < -0.14 : q < -1.3)
                      : fact.rule == "close"  ? (joint.slides ? q > 0 : q > -0.005)
                      : fact.rule == "turnon" ? q >= 0.5
                                              : q < 0;
      if (is != asks_all) return is;
    }
  }
  return asks_all;
}

bool PlainRules::holds(const PlainState& state, bool touching) const {
  return std::ranges::all_of(goal_,
                             [&](const Fact& fact) { return holds(state, fact, touching); });
}

std::pair<Vec3, Vec3> PlainRules::wanted(const PlainState& state, const Fact& fact) const {
  const auto region = regions_.find(fact.where);
  if (region == regions_.end())
    return {state.objects.at(fact.where).position + Vec3(0, 0, 0.02), Vec3(0.03, 0.03, 0.03)};
  const Site site = placed(state, region->second);
  const Vec3 reach = (site.pose.rotation.toRotationMatrix() * site.size).cwiseAbs();
  return {site.pose.position + Vec3(0, 0, fact.rule == "on" ? 0.04 : 0), reach + Vec3(0, 0, 0.04)};
}

}  // namespace probe::libero
