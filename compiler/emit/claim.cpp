// Claims as records: what instructions say of places, with the programs that judge them.
#include <algorithm>

#include "compiler/define/claim.h"
#include "compiler/define/support.h"
#include "compiler/define/thing.h"
#include "compiler/define/views.h"
#include "compiler/emit/emitter.h"

namespace probe::emit {
namespace {

// All that a claim's program depends on.
std::vector<std::uint32_t> shape_of_claim(const Model& model, const sema::Task& task,
                                          const sema::Claim& claim, sema::CameraId camera,
                                          std::size_t bodies) {
  std::vector<std::uint32_t> shape = {static_cast<std::uint32_t>(task.scene),
                                      static_cast<std::uint32_t>(camera),
                                      static_cast<std::uint32_t>(bodies)};
  for (const ObjectId id : task.objects()) {
    shape.push_back(static_cast<std::uint32_t>(task.role_of(id)));
    if (model.exprs.names_objects) shape.push_back(static_cast<std::uint32_t>(id));
  }
  for (const auto& [role, id] : sema::things_of(task)) {
    shape.push_back(static_cast<std::uint32_t>(role));
    shape.push_back(static_cast<std::uint32_t>(id));
  }
  const auto add = [&](const std::vector<std::uint16_t>& list) {
    shape.push_back(size32(list));
    shape.insert(shape.end(), list.begin(), list.end());
  };
  for (const lower::ClaimedBody& body : claim.claimed) {
    shape.insert(shape.end(), {body.body, body.is_meant ? 1u : 0u, size32(body.relations)});
    for (const lower::ClaimedBody::Relation& one : body.relations) {
      shape.insert(shape.end(),
                   {one.relation->span.file.value, one.relation->span.begin, size32(one.alike)});
      add(one.of);
      for (const auto& alike : one.alike) add(alike);
    }
  }
  return shape;
}

}  // namespace

void Emitter::add_claims(const sema::Task& task, const std::vector<lower::Body>& bodies,
                         std::uint32_t index) {
  const sema::CameraId camera = sema::views_of(model_, task).front().camera;
  for (const sema::Claim& claim : sema::claims_of(model_, task)) {
    const auto [known, is_new] = claim_programs_.try_emplace(
        shape_of_claim(model_, task, claim, camera, bodies.size()), plan::kNone);
    if (is_new) {
      auto program = lower::lower_claim(
          model_, claim.claimed, bodies,
          sema::frame_of(model_, model_.scenes[task.scene], model_.cameras[camera]), diagnostics_);
      if (program) {
        known->second = keep_program(std::move(*program));
      } else if (!diagnostics_.has_errors()) {
        diagnostics_.report(
            Code::P0601, claim.phrase->text.span,
            "what \"" + claim.phrase->text.text + "\" means needs more than 4096 instructions");
      }
    }
    if (known->second == plan::kNone) continue;
    plan::ClaimRecord record;
    record.task = index;
    record.body = claim.body;
    record.program = known->second;
    record.text = writer_.text(claim.phrase->text.text);
    records().claims.push_back(record);
  }
  for (const sema::Put& put : sema::puts_of(model_, task)) {
    const auto where = sema::where_of(model_, task, *put.place);
    if (where) add_put(task, put, *where, bodies, index);
  }
}

// What a layout puts somewhere lies there when everything has come to rest.
void Emitter::add_put(const sema::Task& task, const sema::Put& put, ObjectId where,
                      const std::vector<lower::Body>& bodies, std::uint32_t index) {
  const sema::Object& carrier = model_.objects[where];
  const auto body_of = [&](ObjectId id) {
    const auto& of = model_.objects[id].of;
    const auto at = std::ranges::find_if(bodies, [&](const lower::Body& body) {
      return of ? body.kind == plan::BodyKind::kPart && body.part == of->part &&
                      body.index == static_cast<std::uint32_t>(of->fixture)
                : body.kind == plan::BodyKind::kObject &&
                      body.index == static_cast<std::uint32_t>(id);
    });
    return static_cast<std::uint16_t>(at - bodies.begin());
  };
  lower::PutBody put_body{body_of(put.object), body_of(where), nullptr,
                          put.place->how == sema::Place::kIn};
  std::uint32_t region = plan::kNone;
  if (carrier.of && carrier.of->region) {
    region = *carrier.of->region;
    put_body.region = &model_.fixtures[carrier.of->fixture].regions[region].region;
  }
  const std::vector<std::uint32_t> shape = {plan::kNone,
                                            put_body.body,
                                            put_body.carrier,
                                            region,
                                            static_cast<std::uint32_t>(where),
                                            put_body.in ? 1u : 0u};
  const auto [known, is_new] = claim_programs_.try_emplace(shape, plan::kNone);
  if (is_new) {
    const sema::CameraId camera = sema::views_of(model_, task).front().camera;
    auto program = lower::lower_put(
        model_, put_body, put.place->where.span, bodies,
        sema::frame_of(model_, model_.scenes[task.scene], model_.cameras[camera]), diagnostics_);
    if (program) known->second = keep_program(std::move(*program));
  }
  if (known->second == plan::kNone) return;
  plan::ClaimRecord record;
  record.task = index;
  record.body = put_body.body;
  record.program = known->second;
  record.text = writer_.text(model_.objects[put.object].name + (put_body.in ? " in " : " on ") +
                             carrier.name);
  records().claims.push_back(record);
}

}  // namespace probe::emit
