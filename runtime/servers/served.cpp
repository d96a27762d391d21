#include "runtime/servers/served.h"

#include <algorithm>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"
#include "runtime/servers/known_observations.h"
#include "runtime/servers/listening.h"
#include "runtime/servers/profile_words.h"
#include "runtime/servers/protocol.h"

namespace probe::servers {
namespace {

class ServedNull final : public ServedPolicy {
 public:
  // `size` numbers, each a change.
  explicit ServedNull(std::size_t size) : still_(policy::Action::zeros(size)) {
    still_.gripper() = 1;
  }
  void reset() override {}
  Result<std::vector<policy::Action>> answer(const Asked&, int count) override {
    return std::vector<policy::Action>(static_cast<std::size_t>(count), still_);
  }

 private:
  policy::Action still_;
};

class ServedDigest final : public ServedPolicy {
 public:
  // Answers have `size` numbers: a tool's, or joints' and the gripper's.
  explicit ServedDigest(std::size_t size) : size_(size) {}
  void reset() override {}
  Result<std::vector<policy::Action>> answer(const Asked& asked, int count) override {
    const Sha256 seen = Hasher()
                            .bytes(std::as_bytes(std::span(asked.picture.bytes)))
                            .hash(sha256(asked.words))
                            .finish();
    policy::Draws draws(little_endian_number(seen));
    std::vector<policy::Action> actions(static_cast<std::size_t>(count));
    for (policy::Action& action : actions) {
      action = policy::Action::zeros(size_);
      for (std::size_t i = 0; i + 1 < size_; ++i)
        action[i] = (i < 3 ? 0.008 : 0.02) * (2 * draws.uniform() - 1);
      action.gripper() = draws.uniform() < 0.5 ? -1 : 1;
    }
    return actions;
  }

 private:
  std::size_t size_;
};

// Of an observation that no episode has: a question of a proof is answered as a digest does.
Result<std::vector<policy::Action>> answer_unknown(const RecordedEpisodes& recorded,
                                                   const Asked& asked, int count,
                                                   const char* refusal) {
  const auto some =
      std::ranges::find_if(recorded, [](const auto& one) { return !one.second.empty(); });
  const std::size_t size =
      some == recorded.end() ? robot::kActionSize : some->second.front().size();
  if (is_known_observation(asked.picture.bytes, asked.words))
    return ServedDigest(size).answer(asked, count);
  return bad(refusal);
}

class ServedRecorded final : public ServedPolicy {
 public:
  ServedRecorded(std::shared_ptr<const RecordedEpisodes> episodes, bool begins_anew)
      : episodes_(std::move(episodes)), begins_anew_(begins_anew) {}

  void reset() override { actions_ = nullptr; }
  Result<std::vector<policy::Action>> answer(const Asked& asked, int count) override {
    if (actions_ == nullptr || begins_anew_) {
      const auto found =
          episodes_->find(episode_key(to_hex(sha256(std::as_bytes(std::span(asked.picture.bytes)))),
                                      to_hex(sha256(asked.words))));
      if (found != episodes_->end()) {
        actions_ = &found->second;
        next_ = 0;
      }
    }
    // A question of a proof is no step of the episode, in which it may come.
    if (actions_ == nullptr || is_known_observation(asked.picture.bytes, asked.words)) {
      return answer_unknown(*episodes_, asked, count,
                            "picture and instruction begin none of the episodes that are served");
    }
    if (next_ >= actions_->size()) return bad("the episode has no more actions");
    const std::size_t end = std::min(next_ + static_cast<std::size_t>(count), actions_->size());
    std::vector<policy::Action> actions(actions_->begin() + static_cast<std::ptrdiff_t>(next_),
                                        actions_->begin() + static_cast<std::ptrdiff_t>(end));
    next_ = end;
    return actions;
  }

 private:
  std::shared_ptr<const RecordedEpisodes> episodes_;
  bool begins_anew_;
  const std::vector<policy::Action>* actions_ = nullptr;
  std::size_t next_ = 0;
};

class ServedSteps final : public ServedPolicy {
 public:
  explicit ServedSteps(std::shared_ptr<const RecordedEpisodes> steps) : steps_(std::move(steps)) {}

  void reset() override {}
  Result<std::vector<policy::Action>> answer(const Asked& asked, int count) override {
    const auto found =
        steps_->find(episode_key(to_hex(sha256(std::as_bytes(std::span(asked.picture.bytes)))),
                                 to_hex(sha256(asked.words))));
    if (found == steps_->end()) {
      return answer_unknown(*steps_, asked, count,
                            "picture and instruction are of no step that is served, or of several");
    }
    const auto& actions = found->second;
    const std::size_t end = std::min(static_cast<std::size_t>(count), actions.size());
    return std::vector<policy::Action>(actions.begin(),
                                       actions.begin() + static_cast<std::ptrdiff_t>(end));
  }

 private:
  std::shared_ptr<const RecordedEpisodes> steps_;
};

}  // namespace

Result<std::vector<std::vector<policy::Action>>> ServedPolicy::answer_all(
    std::span<const Asked> asked, int count) {
  std::vector<std::vector<policy::Action>> all;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    auto actions = answer(asked[i], count);
    if (!actions) return of_item(actions.failure(), i, asked.size());
    all.push_back(std::move(*actions));
  }
  return all;
}

namespace {

// What asks for small changes needs numbers that are changes.
Status check_changes(const ServedActions& actions, const char* policy) {
  if (actions.form != ActionForm::kJoints) return {};
  return Failure{Fault::kUsage,
                 std::string("`") + policy +
                     "` moves from where the arm is, and under `joint_position` no question says "
                     "where its joints are: serve a run's episodes (`replay:DIR`)",
                 "--policy"};
}

}  // namespace

Result<MakeServedPolicy> serve_null(const ServedActions& actions) {
  PROBE_TRY(check_changes(actions, "null"));
  return MakeServedPolicy([size = actions.size()] { return std::make_unique<ServedNull>(size); });
}

Result<MakeServedPolicy> serve_digest(const ServedActions& actions) {
  PROBE_TRY(check_changes(actions, "digest"));
  return MakeServedPolicy([size = actions.size()] { return std::make_unique<ServedDigest>(size); });
}

MakeServedPolicy serve_recorded(std::shared_ptr<const RecordedEpisodes> episodes,
                                bool begins_anew) {
  return
      [episodes, begins_anew] { return std::make_unique<ServedRecorded>(episodes, begins_anew); };
}

MakeServedPolicy serve_steps(std::shared_ptr<const RecordedEpisodes> steps) {
  return [steps] { return std::make_unique<ServedSteps>(steps); };
}

Status check_batch_asked(const ServeOptions& options, std::size_t questions) {
  const auto most = static_cast<std::size_t>(options.batch);
  if (questions >= 1 && questions <= most) return {};
  return bad("a batch of " + std::to_string(questions) + " questions, and this server takes " +
             (most > 1 ? "1 to " + std::to_string(most) : "no batches"));
}

namespace {

// What a URL of the protocol begins with over TLS; none: it goes over no URL.
const Scheme* tls_scheme(const ProtocolRow& row) {
  for (const Scheme& scheme : url_schemes()) {
    if (scheme.carrier == row.carrier && scheme.is_tls) return &scheme;
  }
  return nullptr;
}

Status check_tls(const ProtocolRow& row, const wire::TlsFiles& tls) {
  if (tls.certificate.empty() && tls.key.empty()) return {};
  if (tls.key.empty())
    return Failure{Fault::kUsage, "a certificate is shown with its key: add --tls-key FILE",
                   "--tls-cert"};
  if (tls.certificate.empty())
    return Failure{Fault::kUsage, "a key is of a certificate: add --tls-cert FILE", "--tls-key"};
  if (tls_scheme(row) != nullptr) return {};
  return Failure{Fault::kUsage,
                 "protocol " + std::string(row.word) +
                     " is spoken plain: it goes over no wss:// or "
                     "https://",
                 "--tls-cert"};
}

}  // namespace

Result<std::unique_ptr<wire::Listener>> serve(Protocol protocol, const ServeOptions& options) {
  PROBE_TRY(check_dialect(protocol, options.dialect, "--dialect"));
  const ProtocolRow& row = row_of(protocol);
  if (options.batch > 1 && row.batches == Batches::kNone) {
    return Failure{Fault::kUsage, "protocol " + std::string(row.word) + " has no batches",
                   "--batch"};
  }
  PROBE_TRY(check_tls(row, options.tls));
  if (names_joints(options.actions.form) && !row.has_joint_actions) {
    return Failure{Fault::kUsage,
                   "protocol " + std::string(row.word) + " has no actions of joints, as these are",
                   "--protocol"};
  }
  ServeOptions numeric = options;
  PROBE_ASSIGN(numeric.address, listening_address(options.address, options.port));
  return row.serve(numeric);
}

bool has_reset(Protocol protocol, const std::string& dialect) {
  const auto has = row_of(protocol).has_reset;
  return has != nullptr && has(dialect);
}

std::string options_for_served(Protocol protocol, const ServeOptions& options) {
  const ServedActions& actions = options.actions;
  const auto form = std::ranges::find(kActionForms, actions.form, &Word<ActionForm>::value);
  const auto gripper = std::ranges::find(kGrippers, actions.gripper, &Word<GripperRange>::value);
  std::string text =
      "action.form=" + std::string(form->text) +
      "&action.units=m_rad&action.rotation=vector&action.gripper=" + std::string(gripper->text) +
      "&action.threshold=none";
  text += row_of(protocol).served_options;
  if (options.keeps_episode && row_of(protocol).has_one_place) text += "&worlds=one";
  if (options.seed) text += "&seed=" + std::to_string(*options.seed);
  if (names_joints(actions.form) && actions.arm_joints > 0)
    text += "&arm.joints=" + std::to_string(actions.arm_joints);
  if (!options.dialect.empty()) text += "&dialect=" + options.dialect;
  if (options.batch > 1) text += "&batch=" + std::to_string(options.batch);
  return text;
}

std::string address_of_served(Protocol protocol, const ServeOptions& options,
                              const std::string& place) {
  const ProtocolRow& row = row_of(protocol);
  const std::string word(row.word), rest = options_for_served(protocol, options);
  const Scheme* const scheme = options.tls.is_on() ? tls_scheme(row) : nullptr;
  if (scheme == nullptr) return word + "://" + place + "?" + rest;
  return std::string(scheme->word) + "://" + place + "?protocol=" + word + "&" + rest;
}

Result<wire::Array> first_picture(const wire::Value& map) {
  if (const auto* entries = map.as<wire::Map>()) {
    for (const auto& [key, value] : *entries) {
      const auto* array = value.as<wire::Array>();
      if (array == nullptr || array->dtype != "|u1" || array->shape.size() < 3 ||
          array->shape.back() != 3) {
        continue;
      }
      wire::Array picture = *array;  // without leading dimensions of 1
      picture.shape.erase(picture.shape.begin(), picture.shape.end() - 3);
      PROBE_TRY(wire::check_fit(picture));
      return picture;
    }
  }
  return bad("expected a picture, u8 [height, width, 3], among others; got " + wire::describe(map));
}

Result<std::string> text_at(const wire::Value& map, std::string_view key) {
  const wire::Value* value = map.find(key);
  if (value != nullptr) {
    // GR00T's texts are in lists.
    while (const auto* list = value->as<wire::List>()) {
      if (list->size() != 1) break;
      value = &list->front();
    }
    if (const auto* text = value->as<std::string>()) return *text;
  }
  return bad("expected a text `" + std::string(key) + "` among others; got " + wire::describe(map));
}

wire::Array actions_array(const std::vector<policy::Action>& actions) {
  std::vector<double> numbers;
  for (const policy::Action& action : actions)
    numbers.insert(numbers.end(), action.begin(), action.end());
  const std::size_t size = actions.empty() ? robot::kActionSize : actions.front().size();
  return wire::array_f64(
      {static_cast<std::int64_t>(actions.size()), static_cast<std::int64_t>(size)}, numbers);
}

}  // namespace probe::servers
