// Whether what makes tasks different reached the policy: the instructions and pictures that were
// sent, as their hashes in the rows have it, against what the plan says should differ.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/store/results.h"

namespace probe::plan {
class Plan;
}

namespace probe::run {

struct DeliveryFinding {
  enum class Kind {
    kSamePrompt,   // two instructions of the plan, one text sent
    kManyPrompts,  // one instruction of the plan, several texts sent
    kSamePicture,  // a variant and its baseline, equal first pictures of different starts
    kNeverSaid,    // a later sentence that was said in no episode
    kNothing,      // no valid episode: what reached the policy cannot be said
    kLive,         // of a run whose world does not wait: how often and how late the policy answered
  };
  Kind kind = Kind::kSamePrompt;
  std::string task, other;  // the variant and its baseline, or any two tasks; `other` may be empty
  std::string axes;         // of kSamePicture: what differs, "camera, light"
  int episodes = 0;         // that show it
  int compared = 0;         // that could
  std::string sentence;     // for people
  bool operator==(const DeliveryFinding&) const = default;
};

// The same of rows that are not all there at once.
class Delivery {
 public:
  explicit Delivery(const plan::Plan& plan);  // which must live as long
  ~Delivery();
  Delivery(Delivery&&) noexcept;
  void add(const store::ResultRow& row);
  std::vector<DeliveryFinding> findings() const;

 private:
  class Detector;
  std::unique_ptr<Detector> detector_;
};

// Of rows of one run of `plan`; tasks that the plan does not have are passed over. A policy in this
// process is compared by what it was shown. Ascending by the plan's task order. Without a valid row
// the first finding is that nothing can be said, and invalid ones may have others. Which later
// sentences were said is known of proven rows alone.
std::vector<DeliveryFinding> check_delivery(const plan::Plan& plan,
                                            std::span<const store::ResultRow> rows);

// A JSON array of objects {kind, task, other, axes, episodes, compared, sentence}; kinds are
// same_prompt, many_prompts, same_picture, never_said, nothing, live.
std::string to_json(std::span<const DeliveryFinding> findings);

}  // namespace probe::run
