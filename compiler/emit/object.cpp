// Objects as records.
#include "compiler/emit/emitter.h"
#include "runtime/base/asset_path.h"

namespace probe::emit {

plan::Slice Emitter::add_covers(const std::map<plan::CoverOf, sema::Cover>& covers,
                                AssetOwner owner) {
  std::vector<plan::CoverRecord> rows;
  for (const auto& [of, cover] : covers) {
    const std::string path = assets_.find("textures/" + cover.picture.text, kPhotoExtensions);
    const std::uint32_t picture =
        assets_.add(path, plan::AssetKind::kPhoto, cover.picture.span, owner);
    rows.push_back({static_cast<std::uint32_t>(of), picture, cover.side});
  }
  if (rows.empty()) return {};
  return plan::append(records().covers, std::span<const plan::CoverRecord>(rows));
}

void Emitter::add_object(ObjectId id) {
  if (!objects_.add(id, size32(records().objects))) return;
  const sema::Object& object = model_.objects[id];
  plan::ObjectRecord record;
  record.name = writer_.text(object.name);
  record.text = writer_.text(object.text.text);
  const AssetOwner owner{AssetOwner::Kind::kObject, static_cast<std::uint32_t>(id)};
  const MeshPair meshes = find_meshes("objects/" + object.mesh.text);
  record.visual = assets_.add(meshes.visual, plan::AssetKind::kVisualMesh, object.mesh.span, owner);
  record.collision =
      assets_.add(meshes.collision, plan::AssetKind::kCollisionMesh, object.mesh.span, owner);
  record.box_min = object.box_min;
  record.box_max = object.box_max;
  record.density = object.density;
  if (object.mass) {
    plan::MassRecord mass;
    mass.mass = object.mass->mass;
    if (object.mass->spread) {
      mass.centre = object.mass->spread->centre;
      mass.inertia = object.mass->spread->inertia;
    }
    record.mass = plan::append(records().masses, std::span<const plan::MassRecord>(&mass, 1));
  }
  if (object.damping != sema::Damping{}) {
    const plan::DampingRecord damping{object.damping.shift, object.damping.turn};
    record.damping =
        plan::append(records().dampings, std::span<const plan::DampingRecord>(&damping, 1));
  }
  record.friction = object.friction;
  if (object.scale != 1) record.scale = object.scale;
  if (object.paint) {
    const auto& rgb = object.paint->rgb;
    record.paint = {rgb[0], rgb[1], rgb[2], 1};
  }
  if (object.texture) record.cover = add_covers({{plan::CoverOf::kObject, *object.texture}}, owner);
  add_regions(object.regions, object.name, plan::BodyKind::kObject, size32(records().objects));
  add_span(plan::SpanKind::kObjects, size32(records().objects), object.span);
  records().objects.push_back(record);
}

}  // namespace probe::emit
