// Objects as records.
#include "compiler/emit/emitter.h"

namespace probe::emit {

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
  record.friction = object.friction;
  add_regions(object.regions, object.name, plan::BodyKind::kObject, size32(records().objects));
  add_span(plan::SpanKind::kObjects, size32(records().objects), object.span);
  records().objects.push_back(record);
}

}  // namespace probe::emit
