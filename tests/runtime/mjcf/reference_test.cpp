// Models that MuJoCo has compiled, where they are at hand: every number of every class.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "runtime/mjcf/mass.h"
#include "runtime/mjcf/read.h"

namespace probe::mjcf {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string reference() {
  const char* elsewhere = std::getenv("VLAPROBE_REFERENCE");
  return (elsewhere != nullptr ? elsewhere : VLAPROBE_SOURCE_DIR "/../shared/reference") +
         std::string("/libero/");
}

std::vector<double> numbers(const Json& text) {
  std::vector<double> out;
  if (!text.is_string()) return out;
  std::istringstream in(text.get<std::string>());
  for (double x = 0; in >> x;) out.push_back(x);
  return out;
}

// `expected` is a text of numbers, or not said.
template <typename Vector>
void check_numbers(const Json& of, const char* key, const Vector& found) {
  if (!of.contains(key) || of[key].is_null()) return;
  const std::vector<double> wanted = numbers(of[key]);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    CAPTURE(key);
    CHECK(found[static_cast<int>(i)] == doctest::Approx(wanted[i]).epsilon(1e-12));
  }
}

void check_turn(const Json& of, const Quat& found) {
  if (!of.contains("quat") || of["quat"].is_null()) return;
  const auto q = numbers(of["quat"]);
  const Quat wanted = Quat(q[0], q[1], q[2], q[3]).normalized();
  CHECK(std::abs(wanted.dot(found)) == doctest::Approx(1).epsilon(1e-12));
}

void check_place(const Json& of, const Pose& found) {
  if (of.contains("pos") && !of["pos"].is_null()) check_numbers(of, "pos", found.position);
  check_turn(of, found.rotation);
}

// The body and those on it, in the file's order.
std::vector<const Body*> bodies_from(const Model& model, std::size_t root) {
  std::vector<const Body*> found;
  std::vector<bool> within(model.bodies.size(), false);
  for (std::size_t i = root; i < model.bodies.size(); ++i) {
    within[i] = i == root || within[static_cast<std::size_t>(model.bodies[i].parent)];
    if (within[i]) found.push_back(&model.bodies[i]);
  }
  return found;
}

TEST_CASE(
    "the classes of LIBERO have the bodies, geoms, sites, joints, masses and inertias that MuJoCo "
    "compiled") {
  std::ifstream in(reference() + "libero_object_classes.json");
  if (!in) {
    MESSAGE("skipped: no ../shared/reference/libero");
    return;
  }
  const Json classes = Json::parse(in);
  const std::string assets = reference() + "libero_assets/";
  std::size_t bodies = 0, geoms = 0, sites = 0, joints = 0;
  double worst = 0;
  for (const auto& [name, entry] : classes.items()) {
    CAPTURE(name);
    const auto model = read_model(assets + "libero/" + entry["xml"].get<std::string>(),
                                  {assets + "robosuite/base.xml"});
    INFO((model ? std::string() : to_text(model.failure())));
    REQUIRE(model.ok());
    std::size_t root = 0;
    for (std::size_t i = 0; i < model->bodies.size(); ++i) {
      if (model->bodies[i].name == "object") root = i;
    }
    const auto found = bodies_from(*model, root);
    REQUIRE(found.size() == entry["bodies"].size());
    REQUIRE(found.size() == entry["compiled_bodies"].size());
    for (std::size_t b = 0; b < found.size(); ++b) {
      const Json& wanted = entry["bodies"][b];
      const Body& body = *found[b];
      ++bodies;
      if (b > 0) CHECK(body.name == wanted["name"].get<std::string>());
      check_place(wanted, body.pose);
      REQUIRE(body.geoms.size() == wanted["geoms"].size());
      for (std::size_t g = 0; g < body.geoms.size(); ++g) {
        const Json& geom = wanted["geoms"][g];
        ++geoms;
        check_place(geom, body.geoms[g].pose);
        check_numbers(geom, "size", body.geoms[g].size);
        check_numbers(geom, "friction", body.geoms[g].friction);
        check_numbers(geom, "solref", body.geoms[g].solref);
        check_numbers(geom, "solimp", body.geoms[g].solimp);
        if (geom.contains("group")) CHECK(std::to_string(body.geoms[g].group) == geom["group"]);
        if (geom.contains("contype"))
          CHECK(std::to_string(body.geoms[g].contype) == geom["contype"]);
        if (geom.contains("conaffinity"))
          CHECK(std::to_string(body.geoms[g].conaffinity) == geom["conaffinity"]);
        if (geom.contains("mesh"))
          CHECK(model->meshes[static_cast<std::size_t>(body.geoms[g].mesh)].name == geom["mesh"]);
      }
      REQUIRE(body.sites.size() == wanted["sites"].size());
      for (std::size_t s = 0; s < body.sites.size(); ++s) {
        ++sites;
        CHECK(body.sites[s].name == wanted["sites"][s]["name"].get<std::string>());
        check_place(wanted["sites"][s], body.sites[s].pose);
        check_numbers(wanted["sites"][s], "size", body.sites[s].size);
      }
      REQUIRE(body.joints.size() == wanted["joints"].size());
      for (std::size_t j = 0; j < body.joints.size(); ++j) {
        const Json& joint = wanted["joints"][j];
        ++joints;
        CHECK(body.joints[j].name == joint["name"].get<std::string>());
        CHECK((body.joints[j].motion == Motion::kSlide) == (joint["type"] == "slide"));
        check_numbers(joint, "axis", body.joints[j].axis);
        check_numbers(joint, "range", std::array{body.joints[j].lower, body.joints[j].upper});
        CHECK(body.joints[j].limited);
        check_numbers(joint, "damping", std::array{body.joints[j].damping});
      }
      const Json& compiled = entry["compiled_bodies"][b];
      const auto mass = mass_of(*model, body, {});
      REQUIRE(mass.ok());
      const double kg = compiled["mass"];
      const auto relative = [&](double error, double size) {
        if (size > 0) worst = std::max(worst, error / size);
        return size > 0 ? error / size : error;
      };
      CHECK(relative(std::abs(mass->mass - kg), kg) < 1e-9);
      const auto center = compiled["ipos"].get<std::array<double, 3>>();
      const auto q = compiled["iquat"].get<std::array<double, 4>>();
      const auto moments = compiled["inertia"].get<std::array<double, 3>>();
      if (kg == 0) continue;
      CHECK((mass->center - to_vec(center)).norm() < 1e-9);
      const Mat3 turn = to_quat(q).normalized().toRotationMatrix();
      const Mat3 inertia = turn * to_vec(moments).asDiagonal() * turn.transpose();
      // Seven digits of the moments of the smallest were kept.
      CHECK(relative((mass->inertia - inertia).norm(), inertia.norm()) < 6e-7);
    }
  }
  CHECK(classes.size() == 33);
  MESSAGE(bodies, " bodies, ", geoms, " geoms, ", sites, " sites, ", joints,
          " joints; masses and inertias at most ", worst, " off, relative");
}

}  // namespace
}  // namespace probe::mjcf
