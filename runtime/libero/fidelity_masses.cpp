// Masses, centres and inertias of the physics against what MuJoCo's compiler made of the models.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "runtime/libero/fidelity.h"

namespace probe::libero {
namespace {

Mat3 inertia_of(const Json& body) {
  const auto q = body["iquat"].get<std::vector<double>>();
  const auto moments = body["inertia"].get<std::vector<double>>();
  const Mat3 turn = Quat(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return turn * Vec3(moments.data()).asDiagonal() * turn.transpose();
}

// That the classes of all recorded tasks are there, with all that is compared.
Status check_classes(const Json& classes, const Records& records) {
  const std::string file = "libero_object_classes.json";
  for (const RecordedTask& task : records.tasks()) {
    for (const char* const things : {"objects", "fixtures"}) {
      for (const auto& [name, said] : task.said[things].items()) {
        const std::string cls = said["cls"].text();
        PROBE_ASSIGN(const Json* entry, member(classes, cls, JsonKind::kObject, file));
        const std::string where = file + ", " + cls;
        PROBE_ASSIGN(const Json* compiled,
                     member(*entry, "compiled_bodies", JsonKind::kArray, where));
        if (compiled->size() > 1) {
          PROBE_ASSIGN(const Json* bodies, member(*entry, "bodies", JsonKind::kArray, where));
          if (bodies->size() != compiled->size())
            return Failure{Fault::kUsage, "as many bodies as were compiled are expected", where};
          for (const Json& body : *bodies) {
            if (!body.is_object() || body.find("pos") == nullptr)
              return Failure{Fault::kUsage, "a body has no `pos`", where};
          }
        }
        for (const Json& body : *compiled) {
          PROBE_TRY(member(body, "name", JsonKind::kText, where));
          PROBE_TRY(member(body, "mass", JsonKind::kNumber, where));
          PROBE_TRY(numbers(body, "ipos", 3, where));
          PROBE_TRY(numbers(body, "iquat", 4, where));
          PROBE_TRY(numbers(body, "inertia", 3, where));
        }
      }
    }
  }
  return {};
}

// Of a body in the one that carries it, as the model writes it: it is not turned there.
Vec3 place_of(const Json& body) {
  Vec3 place = Vec3::Zero();
  if (body["pos"].is_string()) {
    std::istringstream numbers(body["pos"].text());
    numbers >> place[0] >> place[1] >> place[2];
  }
  return place;
}

}  // namespace

Result<FidelityRow> masses_row(Imported& imported, const Records& records) {
  constexpr double kBar = 1e-6;
  FidelityRow row{"masses, centres, inertias",
                  "1e-6, relative; 1e-6 m",
                  "",
                  "what the physics weighs against the models as MuJoCo compiled them",
                  Held::kNo,
                  {}};
  PROBE_ASSIGN(const Json classes, records.json("libero_object_classes.json"));
  PROBE_TRY(check_classes(classes, records));
  double mass = 0, centre = 0, inertia = 0;
  std::set<std::string> seen;
  for (const RecordedTask& task : records.tasks()) {
    bool has_new = false;
    for (const auto& [name, said] : task.said["objects"].items())
      has_new = has_new || !seen.contains(said["cls"].text());
    for (const auto& [name, said] : task.said["fixtures"].items())
      has_new = has_new || !seen.contains(said["cls"].text());
    if (!has_new) continue;
    PROBE_ASSIGN(const plan::Plan* plan, imported.plan(task.suite));
    PROBE_ASSIGN(const auto assets, imported.assets(task.suite, task.name()));
    const plan::TaskRecord& record = plan->tasks()[*plan->find_task(task.name())];
    const auto compare = [&](const std::string& cls, double got, const Vec3& at, const Mat3& about,
                             const Json& wanted) {
      const double kg = wanted["mass"].get<double>();
      const Mat3 moments = inertia_of(wanted);
      const auto place = wanted["ipos"].get<std::vector<double>>();
      const double m = std::abs(got - kg) / kg, c = (at - Vec3(place.data())).norm(),
                   i = (about - moments).norm() / moments.norm();
      mass = worse(mass, m), centre = worse(centre, c), inertia = worse(inertia, i);
      if (!(worse(worse(m, c), i) <= kBar))
        row.others.push_back(
            fmt::format("{}: mass {:.1g}, centre {:.1g} m, inertia {:.1g}", cls, m, c, i));
    };
    for (const plan::BodyRecord& body : plan->bodies(record)) {
      if (body.kind != static_cast<std::uint32_t>(plan::BodyKind::kObject)) continue;
      const Json* said = task.said["objects"].find(std::string(plan->text(body.name)));
      if (said == nullptr || !seen.insert((*said)["cls"].text()).second) continue;
      const plan::ObjectRecord& object = plan->objects()[body.index];
      const auto shape = assets->object_shape(body.index);
      const plan::MassRecord* own = plan->mass(object);
      const double density = own == nullptr ? object.density : own->mass / shape->volume;
      // A body within the thing's own may carry all of it.
      const std::string cls = (*said)["cls"].text();
      const Json& compiled = classes[cls]["compiled_bodies"];
      for (std::size_t b = 0; b < compiled.size(); ++b) {
        if (compiled[b]["mass"].get<double>() == 0) continue;
        const Vec3 within = b == 0 ? Vec3(Vec3::Zero()) : place_of(classes[cls]["bodies"][b]);
        compare(cls, density * shape->volume, shape->center_of_mass - within,
                density * shape->unit_inertia, compiled[b]);
      }
    }
    // Of a fixture what moves: what stands weighs nothing to the physics.
    std::size_t at = 0;
    const auto loaded = assets->fixtures(record.scene);
    for (const auto& [name, said] : task.said["fixtures"].items()) {
      if (at >= loaded.size()) break;
      const stage::LoadedFixture& fixture = *loaded[at++];
      const std::string cls = said["cls"].text();
      if (!seen.insert(cls).second) continue;
      for (const robot::Link& link : fixture.parts.model.links) {
        // What is fixed to another is a part of it there, whatever it is called.
        if (link.parent_joint < 0 ||
            fixture.parts.model.joints[static_cast<std::size_t>(link.parent_joint)].kind ==
                robot::JointKind::kFixed)
          continue;
        for (const Json& wanted : classes[cls]["compiled_bodies"]) {
          if (!wanted["name"].text().ends_with("_" + link.name) ||
              wanted["mass"].get<double>() == 0)
            continue;
          compare(cls + "." + link.name, link.mass, link.center_of_mass, link.inertia, wanted);
        }
      }
    }
  }
  if (seen.empty()) {
    row.how = "the records have no thing of the import";
    row.held = Held::kNotMeasured;
    return row;
  }
  row.figure = fmt::format("{} kinds of things: mass {:.1g}, inertia {:.1g}, centre {:.1g} m",
                           seen.size(), mass, inertia, centre);
  row.held = row.others.empty() ? Held::kYes : Held::kNo;
  return row;
}

}  // namespace probe::libero
