// The imported rules of success on the benchmark's own states: where its own program saw none, none
// is seen, and every verdict is that of a plain rewrite of its code.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "runtime/compile/files.h"
#include "runtime/libero/zip.h"
#include "runtime/plan/fixtures.h"
#include "runtime/plan/plan.h"
#include "runtime/robot/kinematics.h"
#include "runtime/robot/urdf.h"
#include "runtime/vm/judge.h"
#include "runtime/wire/npy.h"
#include "tests/runtime/libero/imported.h"

namespace probe::libero {
namespace {

namespace fs = std::filesystem;

using Poses = std::map<std::string, Pose, std::less<>>;  // by the benchmark's names

Pose pose_at(const double* q) {
  return {Vec3(q[0], q[1], q[2]), Quat(q[3], q[4], q[5], q[6]).normalized()};
}
Vec3 vector_in(const std::string& text) {
  Vec3 v = Vec3::Zero();
  std::sscanf(text.c_str(), "%lf %lf %lf", &v[0], &v[1], &v[2]);
  return v;
}
Quat turn_in(const Json* text) {
  double w = 1, x = 0, y = 0, z = 0;
  if (text != nullptr && text->is_string())
    std::sscanf(text->text().c_str(), "%lf %lf %lf %lf", &w, &x, &y, &z);
  return Quat(w, x, y, z).normalized();
}

// One state of a task: objects, fixtures where they stand, their joints.
struct World {
  Poses objects, fixtures;
  std::map<std::string, double, std::less<>> joints;  // "wooden_cabinet_1_top_level"
};

// LIBERO's rules, of its own names and models (libero_object_classes.json), all things touching or
// none.
class PlainRules {
 public:
  PlainRules(const Json& classes, const Json& task) : classes_(classes), task_(task) {}

  // About where a fact of the goal wants its object, and how far from there it may be by far.
  std::pair<Vec3, Vec3> wanted(const World& world, const Json& fact) const {
    const std::string where = fact[2].text();
    const Json* region = task_["regions"].find(where);
    if (region == nullptr)
      return {world.objects.at(where).position + Vec3(0, 0, 0.02), Vec3(0.03, 0.03, 0.03)};
    const std::string target = (*region)["target"].text();
    const Site site = target == task_["workspace"].text()
                          ? zone_of(*region, where)
                          : site_of(world, target, where.substr(target.size() + 1));
    const Vec3 reach = (site.pose.rotation.toRotationMatrix() * site.size).cwiseAbs();
    return {site.pose.position + Vec3(0, 0, fact[0].text() == "on" ? 0.04 : 0),
            reach + Vec3(0, 0, 0.04)};
  }

  bool holds(const World& world, bool touching) const {
    for (const Json& fact : task_["goal"]) {
      if (!holds(world, fact, touching)) return false;
    }
    return true;
  }

 private:
  const Json& class_of(const std::string& thing) const {
    const Json* said = task_["objects"].find(thing);
    if (said == nullptr) said = task_["fixtures"].find(thing);
    return classes_[(*said)["cls"].text()];
  }

  const Json& body_of(const std::string& thing, const std::string& name) const {
    const Json& bodies = class_of(thing)["bodies"];
    for (const Json& body : bodies) {
      if (body["name"].text() == name) return body;
    }
    FAIL("no body ", name);
    return bodies;
  }

  // Where a body is: its chain from the thing's own, joints that slide along y or turn about z.
  Pose body_pose(const World& world, const std::string& thing, const std::string& name) const {
    const auto object = world.objects.find(thing);
    if (name == "main")
      return object != world.objects.end() ? object->second : world.fixtures.at(thing);
    const Json& body = body_of(thing, name);
    Pose pose = body_pose(world, thing, body["parent"].text());
    if (body["pos"].is_string()) pose.position += pose.rotation * vector_in(body["pos"].text());
    pose.rotation = pose.rotation * turn_in(body.find("quat"));
    for (const Json& joint : body["joints"]) {
      const double q = world.joints.at(thing + "_" + joint["name"].text());
      if (joint["type"].text() == "slide") {
        pose.position += pose.rotation * Vec3(0, q, 0);
      } else {
        pose.rotation = pose.rotation * Quat(Eigen::AngleAxisd(q, Vec3::UnitZ()));
      }
    }
    return pose;
  }

  struct Site {
    Pose pose;
    Vec3 size;
    std::string body;
  };
  Site site_of(const World& world, const std::string& thing, const std::string& own) const {
    for (const Json& body : class_of(thing)["bodies"]) {
      for (const Json& site : body["sites"]) {
        if (site["name"].text() != own) continue;
        const Pose at = body_pose(world, thing, body["name"].text());
        return {{at.position + at.rotation * vector_in(site["pos"].text()),
                 at.rotation * turn_in(site.find("quat"))},
                vector_in(site["size"].text()),
                body["name"].text()};
      }
    }
    FAIL("no site ", own);
    return {};
  }

  bool holds(const World& world, const Json& fact, bool touching) const {
    const std::string rule = fact[0].text(), what = fact[1].text();
    if (rule == "on" || rule == "in") {
      const Vec3 p = world.objects.at(what).position;
      const std::string where = fact[2].text();
      const Json* region = task_["regions"].find(where);
      if (region == nullptr) {
        const Vec3 other = world.objects.at(where).position;
        return touching && p.z() >= other.z() && (p - other).head<2>().norm() < 0.03;
      }
      const std::string target = (*region)["target"].text();
      if (target == task_["workspace"].text()) return is_on(p, zone_of(*region, where));
      const Site site = site_of(world, target, where.substr(target.size() + 1));
      return rule == "on" ? touching && is_on(p, site) : is_in(p, site);
    }
    const Json* region = task_["regions"].find(what);
    const std::string thing = region == nullptr ? what : (*region)["target"].text();
    std::string body;
    if (region != nullptr) body = site_of(world, thing, what.substr(thing.size() + 1)).body;
    for (const Json& one : class_of(thing)["bodies"]) {
      if (!body.empty() && one["name"].text() != body) continue;
      for (const Json& joint : one["joints"]) {
        const double q = world.joints.at(thing + "_" + joint["name"].text());
        const bool slides = joint["type"].text() == "slide";
        if (rule == "open") return slides ? q < -0.14 : q < -1.3;
        if (rule == "close") return slides ? q > 0 : q > -0.005;
        if (rule == "turnon") return q >= 0.5;
        if (rule == "turnoff") return q < 0;
      }
    }
    FAIL("no joint of ", what);
    return false;
  }

  Site zone_of(const Json& region, const std::string& name) const {
    const Json& sites = task_["sites"];
    const Json& range = region["ranges"][0];
    const std::string problem = task_["problem"].text();
    const bool study = problem.find("Study") != problem.npos;
    const double z = problem.find("Kitchen") != problem.npos  ? 0.875
                     : study                                  ? 0.867
                     : problem.find("Living") != problem.npos ? 0.41
                     : problem.find("Floor") != problem.npos  ? 0.02
                                                              : 0.895;
    const auto number = [](const Json& json) { return json.get<double>(); };
    return {{Vec3((number(range[0]) + number(range[2])) / 2 + (study ? -0.2 : 0),
                  (number(range[1]) + number(range[3])) / 2, z),
             Quat::Identity()},
            Vec3(number(sites[name]["size"][0]), number(sites[name]["size"][1]), 0.007),
            ""};
  }

  static bool is_on(const Vec3& p, const Site& site) {
    const Vec3 d = site.pose.rotation.toRotationMatrix() * (p - site.pose.position);
    return site.size.z() - 0.005 < d.z() && d.z() < site.size.z() + 0.1 &&
           std::abs(d.x()) < site.size.x() && std::abs(d.y()) < site.size.y();
  }
  static bool is_in(const Vec3& p, const Site& site) {
    const Vec3 t = (site.pose.rotation.toRotationMatrix() * site.size).cwiseAbs();
    Vec3 low = site.pose.position - t;
    low.z() -= 0.01;
    return (p.array() > low.array()).all() && (p.array() < (site.pose.position + t).array()).all();
  }

  const Json &classes_, &task_;
};

}  // namespace

TEST_CASE("the judge on stored and settled states of the benchmark, against a plain rewrite") {
  if (!test::has_reference()) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  const fs::path to = test::imported_reference("judged");
  const auto json = [](const std::string& name) {
    const auto text = read_file(test::reference() + name);
    REQUIRE(text.ok());
    return Json::parse(*text);
  };
  const Json all = json("libero_tasks.json"), classes = json("libero_object_classes.json");
  const auto settled = read_file(test::reference() + "libero_settled.npz");
  REQUIRE(settled.ok());
  const std::span<const std::uint8_t> archive(
      reinterpret_cast<const std::uint8_t*>(settled->data()), settled->size());
  std::size_t stored_states = 0, settled_states = 0, met = 0, tried = 0;
  std::map<std::string, std::size_t> met_by;  // goals by their rules
  std::mt19937_64 draws(11);
  const auto draw = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(draws() >> 11) * 0x1p-53;
  };
  for (const Json& task : all["tasks"]) {
    const std::string suite = task["suite"].text();
    // One plan a suite, kept for all of its tasks.
    static std::map<std::string, plan::Plan> plans;
    if (!plans.contains(suite)) {
      compile::FilesRequest request;
      request.assets = to.string();
      auto made = compile::compile_files({(to / (suite + ".probe")).string()}, request);
      REQUIRE(made.ok());
      REQUIRE(made->ok);
      auto opened = plan::Plan::from_bytes(std::move(made->plan));
      REQUIRE(opened.ok());
      plans.emplace(suite, std::move(opened).value());
    }
    const plan::Plan& plan = plans.at(suite);
    std::string name = task["file"].text();
    name.resize(name.size() - 5);
    for (char& c : name) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    CAPTURE(name);
    const auto index = plan.find_task(name);
    REQUIRE(index.has_value());
    const plan::TaskRecord& record = plan.tasks()[*index];
    const plan::SceneRecord& scene = plan.scenes()[record.scene];
    const auto bodies = plan.bodies(record);
    const PlainRules rules(classes, task);

    // The scene's fixtures, each with its tree; in the order of the problem's.
    struct Standing {
      std::string name;
      Pose root;
      robot::RobotModel model;
      std::vector<std::string> joints;
    };
    std::vector<Standing> standing;
    for (const std::uint32_t f : plan.fixtures(scene)) {
      const plan::FixtureRecord& fixture = plan.tables().fixtures[f];
      auto model = robot::load_urdf((to / plan.text(plan.assets()[fixture.urdf].path)).string());
      REQUIRE(model.ok());
      Standing one{"",
                   {to_vec(fixture.position), Quat(fixture.rotation[0], fixture.rotation[1],
                                                   fixture.rotation[2], fixture.rotation[3])},
                   std::move(*model),
                   {}};
      for (const plan::FixtureJointRecord& joint : plan.joints(fixture))
        one.joints.emplace_back(plan.text(joint.joint));
      standing.push_back(std::move(one));
    }
    REQUIRE(standing.size() == task["fixtures"].size());
    for (std::size_t i = 0; i < standing.size(); ++i)
      standing[i].name = task["fixtures"].items()[i].first;

    // The plan has objects in the order of their roles.
    std::vector<std::string> object_names;
    for (std::size_t i = 0; i < task["objects"].size(); ++i)
      object_names.emplace_back(plan.text(bodies[i].name));
    std::string goal;
    for (const Json& fact : task["goal"]) goal += fact[0].text() + " ";
    // As it is, or with the goal's things and joints about where they are wanted.
    const auto judge_both = [&](std::vector<Pose> objects, std::span<const double> given,
                                bool is_moved) {
      std::vector<double> joints_here(given.begin(), given.end());
      const std::span<const double> joints(joints_here);
      const auto joint_names = [&] {
        std::vector<std::string> names;
        for (const Standing& one : standing) {
          for (const std::string& joint : one.joints) names.push_back(one.name + "_" + joint);
        }
        return names;
      }();
      if (is_moved) {
        World before;
        for (std::size_t i = 0; i < objects.size(); ++i)
          before.objects[object_names[i]] = objects[i];
        for (const Standing& one : standing) before.fixtures[one.name] = one.root;
        for (double& q : joints_here) {
          const double way = draw(0, 1);
          q = way < 0.4 ? draw(-0.16, 0.01) : way < 0.7 ? 0.005 : draw(-0.005, 1);
        }
        for (std::size_t k = 0; k < joint_names.size(); ++k)
          before.joints[joint_names[k]] = joints_here[k];
        // What others are put on comes last in some goals.
        for (int again = 0; again < 2; ++again) {
          for (const Json& fact : task["goal"]) {
            if (fact.size() < 3) continue;
            const auto [middle, reach] = rules.wanted(before, fact);
            Vec3 p = middle;
            for (Eigen::Index i = 0; i < 3; ++i) p[i] += 0.8 * draw(-reach[i], reach[i]);
            before.objects[fact[1].text()].position = p;
          }
        }
        for (std::size_t i = 0; i < objects.size(); ++i)
          objects[i] = before.objects[object_names[i]];
        ++tried;
      }
      World world;
      for (std::size_t i = 0; i < objects.size(); ++i) world.objects[object_names[i]] = objects[i];
      vm::StepSample sample;
      sample.bodies.resize(bodies.size());
      sample.joints.resize(plan.joints(scene).size());
      for (const double q : joints) sample.joints.push_back({q, 0});
      for (std::size_t i = 0; i < objects.size(); ++i) {
        sample.bodies[i].origin = sample.bodies[i].position = objects[i].position;
        sample.bodies[i].rotation = objects[i].rotation;
      }
      std::size_t body = 0, at = 0;
      while (body < bodies.size() &&
             bodies[body].kind != static_cast<std::uint32_t>(plan::BodyKind::kPart)) {
        if (bodies[body].kind == static_cast<std::uint32_t>(plan::BodyKind::kSurface))
          sample.bodies[body].origin = sample.bodies[body].position = Vec3(0, 0, scene.surface_z);
        ++body;
      }
      const auto fixtures = plan.fixtures(scene);
      for (std::size_t i = 0; i < standing.size(); ++i) {
        const Standing& one = standing[i];
        world.fixtures[one.name] = one.root;
        const auto own = joints.subspan(at, one.joints.size());
        at += own.size();
        for (std::size_t k = 0; k < own.size(); ++k)
          world.joints[one.name + "_" + one.joints[k]] = own[k];
        const auto tree = robot::Tree::create(one.model, one.joints);
        REQUIRE(tree.ok());
        std::vector<Pose> poses(tree->link_count());
        tree->link_poses(own, poses);
        for (const plan::PartRecord& part : plan.parts(plan.tables().fixtures[fixtures[i]])) {
          const int link = one.model.find_link(plan.text(part.link));
          REQUIRE(link >= 0);
          const Pose pose = one.root * poses[static_cast<std::size_t>(link)];
          sample.bodies[body].origin = sample.bodies[body].position = pose.position;
          sample.bodies[body++].rotation = pose.rotation;
        }
      }
      REQUIRE(body == bodies.size());
      for (const bool touching : {false, true}) {
        sample.contacts.clear();
        for (std::uint16_t a = 0; touching && a < objects.size(); ++a) {
          for (std::uint16_t b = static_cast<std::uint16_t>(a + 1); b < bodies.size(); ++b)
            sample.contacts.push_back({a, b, Vec3(0, 0, 0.01)});
        }
        std::vector<vm::BodyStart> starts(bodies.size());
        for (std::size_t b = 0; b < bodies.size(); ++b)
          starts[b].position = sample.bodies[b].position;
        sample.step = 1;
        vm::Judge judge(plan, *index);
        REQUIRE(judge.begin(starts).ok());
        REQUIRE(judge.step(sample).ok());
        const bool judged = judge.value(*judge.find_metric("success")) != 0;
        CHECK(judged == rules.holds(world, touching));
        met += judged ? 1 : 0;
        if (judged) ++met_by[goal];
        // Its own program saw success in none of these states.
        if (!is_moved) CHECK_FALSE(judged);
      }
    };

    for (const plan::EpisodeRecord& episode : plan.episodes(record)) {
      std::vector<Pose> objects;
      for (const plan::PlacementRecord& placed : plan.placements(episode))
        objects.push_back({to_vec(placed.position), Quat(placed.rotation[0], placed.rotation[1],
                                                         placed.rotation[2], placed.rotation[3])});
      const std::vector<double> begun = plan::joint_starts_of(plan.tables(), scene, episode);
      judge_both(objects, begun, false);
      judge_both(objects, begun, true);
      ++stored_states;
    }
    const std::string key = suite + (task["index"].get<int>() < 10 ? "_0" : "_") +
                            std::to_string(task["index"].get<int>());
    const auto member = read_zip_member(archive, key + ".npy", std::size_t{1} << 20, "settled");
    if (!member) continue;  // of some tasks alone
    const auto rows = wire::from_npy(wire::Bytes(member->begin(), member->end()));
    REQUIRE(rows.ok());
    const auto count = static_cast<std::size_t>(rows->shape[0]);
    const auto width = static_cast<std::size_t>(rows->shape[1]);
    std::vector<double> values(count * width);
    std::memcpy(values.data(), rows->bytes.data(), rows->bytes.size());
    for (std::size_t r = 0; r < count; ++r) {
      const double* q = &values[r * width + 1 + 9];
      std::vector<Pose> objects(object_names.size());
      for (std::size_t i = 0; i < object_names.size(); ++i, q += 7) {
        const auto at = std::ranges::find(object_names, task["objects"].items()[i].first);
        REQUIRE(at != object_names.end());
        objects[static_cast<std::size_t>(at - object_names.begin())] = pose_at(q);
      }
      std::size_t joints = 0;
      for (const Standing& one : standing) joints += one.joints.size();
      judge_both(objects, std::span<const double>(q, joints), false);
      ++settled_states;
    }
  }
  fs::remove_all(to);
  CHECK(stored_states == 6500);
  CHECK(settled_states == 1850);
  // Every kind of goal is met now and then.
  std::size_t kinds = 0;
  for (const auto& [kind, count] : met_by) {
    CAPTURE(kind);
    CHECK(count > 0);
    ++kinds;
  }
  MESSAGE(stored_states << " stored, " << settled_states << " settled and " << tried
                        << " moved states; " << kinds << " kinds of goals met " << met << " times");
  CHECK(met > 500);
}

}  // namespace probe::libero
