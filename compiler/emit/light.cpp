// Lights as records.
#include "compiler/emit/emitter.h"

namespace probe::emit {

void Emitter::add_light(sema::LightId id) {
  if (!lights_.add(id, size32(records().lights))) return;
  const sema::Light& light = model_.lights[id];
  plan::LightRecord record;
  record.name = writer_.text(light.name);
  record.ambient = light.ambient;
  record.occlusion = light.occlusion;
  record.color = light.color;
  record.suns = plan::append(records().suns, std::span<const plan::SunRecord>(light.suns));
  record.shading = light.lights_vertices ? 1 : 0;
  record.lamps = plan::append(records().lamps, std::span<const plan::LampRecord>(light.lamps));
  records().lights.push_back(record);
}

}  // namespace probe::emit
