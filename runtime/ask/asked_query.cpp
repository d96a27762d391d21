#include "runtime/ask/asked_query.h"

namespace probe::ask {
namespace {

Sha256 draw_of(const AnswerKey& key, const std::string& start_id) {
  return Hasher()
      .text("answer")
      .text(key.question_id)
      .text(start_id)
      .u32(key.rotation)
      .u32(static_cast<std::uint32_t>(key.arm))
      .u64(static_cast<std::uint64_t>(static_cast<std::int64_t>(key.episode)))
      .u64(static_cast<std::uint64_t>(static_cast<std::int64_t>(key.seed)))
      .finish();
}

}  // namespace

Wording wording_of(const plan::Plan& plan, const PreparedLook& look, const Query& query) {
  return word(plan, plan.questions()[query.question], query.rotation, look.picture.width,
              look.picture.height);
}

AskedQuery asked_query(const plan::Plan& plan, const PreparedLook& look, const Query& query,
                       const Wording& wording) {
  const SentPicture* picture = query.arm == Arm::kPicture ? &look.picture
                               : query.arm == Arm::kPrior ? &look.prior
                                                          : nullptr;
  const AnswerKey key = key_of(plan, query);
  return {plan,
          plan.questions()[query.question],
          wording,
          look.truths.at(query.question),
          picture,
          look.picture.width,
          look.picture.height,
          draw_of(key, start_id_of(plan, query.episode)),
          key.arm,
          key.rotation,
          key.episode};
}

}  // namespace probe::ask
