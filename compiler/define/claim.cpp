#include "compiler/define/claim.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "compiler/define/in_start.h"
#include "compiler/define/query.h"
#include "compiler/define/telling.h"
#include "compiler/define/template.h"

namespace probe::sema {
namespace {

// What one object would have to be for the phrase to denote it; nothing where it never does.
std::optional<lower::ClaimedBody> claimed_body(const Model& model, const Scenery& scenery,
                                               const Phrase& phrase, std::uint16_t body,
                                               const Alike& alike) {
  if (std::find(alike.all.begin(), alike.all.end(), body) == alike.all.end()) return std::nullopt;
  lower::ClaimedBody claimed;
  claimed.body = body;
  for (const QueryOp& op : phrase.means) {
    if (op.kind != QueryOp::kRelation) continue;
    const std::optional<std::vector<std::uint16_t>> of =
        related_bodies(model, scenery, op, body, alike);
    if (!of) return std::nullopt;
    lower::ClaimedBody::Relation relation;
    relation.relation = &model.predicates[static_cast<PredicateId>(op.a)];
    relation.of = *of;
    relation.alike.push_back(alike.sure);
    if (alike.all != alike.sure) relation.alike.push_back(alike.all);
    claimed.relations.push_back(std::move(relation));
  }
  return claimed;
}

Claim claim_of(const Model& model, const Task& task, const Phrase& phrase, ObjectId wanted) {
  const Scenery scenery = scenery_of(model, task);
  const Alike alike = alike_of(model, scenery, phrase);
  Claim claim{&phrase, wanted, 0, {}};
  for (std::size_t i = 0; i < scenery.things.size(); ++i) {
    if (scenery.things[i] == wanted) claim.body = scenery.bodies[i];
    auto claimed = claimed_body(model, scenery, phrase, scenery.bodies[i], alike);
    if (!claimed) continue;
    claimed->is_meant = scenery.things[i] == wanted;
    claim.claimed.push_back(std::move(*claimed));
  }
  return claim;
}

}  // namespace

std::vector<Claim> claims_of(const Model& model, const Task& task) {
  std::vector<Claim> claims;
  std::set<ObjectId> known;
  for_each_telling(task, [&](const Task& told) {
    const Template& say = model.templates[told.say];
    for (const Template::Part& part : say.parts) {
      if (!part.slot || part.slot->role == RoleId::kNone) continue;
      for (const ObjectId object : meant_by(model, told, say, *part.slot)) {
        const Referring words = referring(model, told, object);
        if (words.phrase == nullptr || !words.phrase->is_spatial()) continue;
        if (known.insert(object).second)
          claims.push_back(claim_of(model, told, *words.phrase, object));
      }
    }
  });
  return claims;
}

}  // namespace probe::sema
