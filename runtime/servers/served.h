// Our own reference servers: a policy served in each protocol, for whoever wants to try a client or
// a harness without a GPU. Each protocol's side stands in its file of protocols/, beside the
// client.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/policy/policy.h"
#include "runtime/servers/profile.h"
#include "runtime/servers/transport.h"
#include "runtime/wire/listener.h"
#include "runtime/wire/value.h"

namespace probe::servers {

// What a question carries, in every protocol.
struct Asked {
  wire::Array picture;  // the first, u8 [h, w, 3]
  std::string words;
};

// One world's. Answers are actions in the simulator's own convention: m, rotation vector, gripper
// -1 closed .. +1 open.
class ServedPolicy {
 public:
  virtual ~ServedPolicy() = default;
  // A protocol's word that an episode begins; of some there is none.
  virtual void reset() = 0;
  virtual Result<std::vector<policy::Action>> answer(const Asked& asked, int count) = 0;
  // Of several worlds at once, each in its order; only of policies that keep nothing between
  // questions. One after the other, unless overridden.
  virtual Result<std::vector<std::vector<policy::Action>>> answer_all(std::span<const Asked> asked,
                                                                      int count);
};
using MakeServedPolicy = std::function<std::unique_ptr<ServedPolicy>()>;

// What the actions of a served policy are, as a profile says it.
struct ServedActions {
  ActionForm form = ActionForm::kDelta;  // changes of the tool, or joints
  int arm_joints = 0;                    // whose actions these are, of joints
  GripperRange gripper = GripperRange::kSigned;
  std::size_t size() const {
    return names_joints(form) ? static_cast<std::size_t>(arm_joints) + 1 : robot::kActionSize;
  }
  bool operator==(const ServedActions&) const = default;
};
// Stays where it is, gripper open. Of positions of joints there is none (kUsage), nor a digest: no
// question says where the joints are.
Result<MakeServedPolicy> serve_null(const ServedActions& actions = {});
// Moves of at most 8 mm and 0.02 rad that follow from picture and words alone.
Result<MakeServedPolicy> serve_digest(const ServedActions& actions = {});
// Episodes' actions by episode_key of their first picture and their instruction. Such a picture
// begins its episode anew where `begins_anew` (protocols without a reset), else only after a reset.
using RecordedEpisodes = std::map<std::string, std::vector<policy::Action>>;
// Of the SHA-256, in hex, of a picture's bytes and of an instruction's.
inline std::string episode_key(const std::string& picture_sha256, const std::string& words_sha256) {
  return picture_sha256 + "/" + words_sha256;
}
MakeServedPolicy serve_recorded(std::shared_ptr<const RecordedEpisodes> episodes, bool begins_anew);
// What follows each step by the step's own picture: keeps nothing, so that worlds may share a
// connection.
MakeServedPolicy serve_steps(std::shared_ptr<const RecordedEpisodes> steps);

struct ServeOptions {
  std::string address = "127.0.0.1";
  std::string port = "0";
  int chunk = 1;  // actions of an answer, at most; vla-eval's have one
  // Questions of a message, at most, or of those that vla-eval's server gathers; 1: no batches.
  int batch = 1;
  std::string dialect;  // of GR00T and OpenVLA, as in a profile
  ServedActions actions;
  bool keeps_episode = false;    // the policy does, from one question to the next
  std::optional<int> seed = {};  // its episodes are of this one alone
  wire::TlsFiles tls = {};       // of protocols over WebSocket and HTTP; none: plain
  MakeServedPolicy policy;
};

// Listens until it goes. Fails (kUsage) where it cannot, and where the protocol has no actions of
// the form.
Result<std::unique_ptr<wire::Listener>> serve(Protocol protocol, const ServeOptions& options);

// Whether the protocol has a word for an episode's beginning.
bool has_reset(Protocol protocol, const std::string& dialect);

// The options of an address that read such a server as it is meant: "action.rotation=vector&...".
std::string options_for_served(Protocol protocol, const ServeOptions& options);

// The address of such a server at `place`, HOST:PORT: "openpi://HOST:PORT?...", and over TLS
// "wss://HOST:PORT?protocol=openpi&...".
std::string address_of_served(Protocol protocol, const ServeOptions& options,
                              const std::string& place);

// For the protocols' files.
// Fails unless there may be that many questions in one message.
Status check_batch_asked(const ServeOptions& options, std::size_t questions);
// The first picture among a map's entries. Fails naming what there is.
Result<wire::Array> first_picture(const wire::Value& map);
Result<std::string> text_at(const wire::Value& map, std::string_view key);
// f64 [n, 7], or as many numbers as the actions have.
wire::Array actions_array(const std::vector<policy::Action>& actions);

}  // namespace probe::servers
