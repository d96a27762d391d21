// Assets as records, and P0202 for those that are not there.
#include <algorithm>
#include <set>

#include "compiler/emit/emitter.h"
#include "compiler/geometry/mesh_origin.h"

namespace probe::emit {

void Emitter::add_assets() {
  for (const Asset& asset : assets_.assets()) {
    plan::AssetRecord record;
    record.path = writer_.text(asset.path);
    record.kind = static_cast<std::uint32_t>(asset.kind);
    record.byte_size = asset.byte_size;
    record.sha256 = asset.hash.bytes;
    records().assets.push_back(record);
  }
}

bool Emitter::needs(const sema::Task& task, const AssetOwner& owner) const {
  switch (owner.kind) {
    case AssetOwner::Kind::kObject: {
      const std::vector<ObjectId> objects = task.objects();
      return std::find(objects.begin(), objects.end(), static_cast<ObjectId>(owner.id)) !=
             objects.end();
    }
    case AssetOwner::Kind::kScene:
      return task.scene == static_cast<sema::SceneId>(owner.id);
    case AssetOwner::Kind::kFixture: {
      const auto& fixtures = model_.scenes[task.scene].fixtures;
      return std::find(fixtures.begin(), fixtures.end(), static_cast<sema::FixtureId>(owner.id)) !=
             fixtures.end();
    }
    case AssetOwner::Kind::kRobot:
      return model_.scenes[task.scene].robot == static_cast<sema::RobotId>(owner.id);
  }
  return false;
}

void Emitter::report_misses(const std::vector<TaskId>& chosen) {
  constexpr std::size_t kNamed = 6;
  std::set<std::string> advised;  // once each
  for (const AssetMiss& miss : assets_.misses()) {
    std::string names;
    std::size_t count = 0;
    for (const TaskId id : chosen) {
      const bool is_needed = std::ranges::any_of(
          miss.owners, [&](const AssetOwner& owner) { return needs(model_.tasks[id], owner); });
      if (!is_needed || ++count > kNamed) continue;
      names += (count == 1 ? "`" : ", `") + model_.tasks[id].name + "`";
    }
    if (count > kNamed) names += " and " + std::to_string(count - kNamed) + " more";
    Diagnostic& said = diagnostics_.report(Situation::kAssetMissing, miss.span,
                                           "asset `" + miss.path + "` " + miss.why);
    said.note("looked for it in the assets folder " + options_.asset_root.text() +
              " and beside the text")
        .note("needed by " + names);
    // Who names a folder of one mug lacks all else.
    const std::string advice = options_.asset_root.advice(miss.path);
    if (!advice.empty() && advised.insert(advice).second) said.help(advice);
    // "objects/mug/visual.glb"
    constexpr std::string_view kObjects = "objects/";
    if (!advice.empty() || !miss.path.starts_with(kObjects)) continue;
    const std::size_t name = kObjects.size();
    const std::string mesh = miss.path.substr(name, miss.path.rfind('/') - name);
    const std::string text(sources_.file(miss.span.file).name());
    if (const std::string pack = sema::pack_advice(text, mesh); advised.insert(pack).second)
      said.help(pack);
  }
}

}  // namespace probe::emit
