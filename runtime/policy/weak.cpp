#include "runtime/policy/weak.h"

#include <charconv>
#include <cmath>
#include <utility>

#include "runtime/policy/scripted.h"

namespace probe::policy {
namespace {

struct Word {
  std::string_view word;
  WeakTo to;
};
constexpr Word kWords[] = {{"ambient", WeakTo::kAmbient},
                           {"power", WeakTo::kPower},
                           {"camera", WeakTo::kCamera},
                           {"clutter", WeakTo::kClutter},
                           {"reworded", WeakTo::kReworded}};

Failure not_read(std::string_view term) {
  return {
      Fault::kUsage,
      "`" + std::string(term) +
          "` is no weak spot: write `ambient<0.12`, `power<0.5`, `camera>=3cm`, `clutter>=2` or "
          "`reworded`, several joined by `+`, with `~0.02` behind a number for a soft edge",
      "--policy"};
}

// A number with `cm` behind it where a length may stand.
bool read_number(std::string_view text, bool is_length, double& to) {
  double scale = 1;
  if (is_length && text.ends_with("cm")) {
    scale = 0.01;
    text.remove_suffix(2);
  } else if (is_length && text.ends_with("m")) {
    text.remove_suffix(1);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
  to *= scale;
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(to) && to >= 0;
}

double value_of(const Surroundings& there, WeakTo what) {
  switch (what) {
    case WeakTo::kAmbient:
      return there.ambient;
    case WeakTo::kPower:
      return there.power;
    case WeakTo::kCamera:
      return there.camera_moved;
    case WeakTo::kClutter:
      return there.clutter;
    case WeakTo::kReworded:
      break;
  }
  return there.reworded ? 1 : 0;
}

class WeakPolicy final : public Policy {
 public:
  WeakPolicy(WeakSpot spot, std::unique_ptr<Policy> inner)
      : spot_(std::move(spot)), inner_(std::move(inner)), still_(make_null()) {}

  Status begin(const EpisodeStart& start) override {
    is_weak_.reset();
    // A generator of its own: what `inner` draws stays as it is.
    draw_ = Draws(start.draw_seed ^ 0x7765616bu).uniform();
    PROBE_TRY(still_->begin(start));
    return inner_->begin(start);
  }
  Result<Action> act(const Observation& observation) override {
    if (observation.privileged == nullptr)
      return Failure{Fault::kUsage, "it goes by what the world is like, which is not told here",
                     "--policy"};
    if (!is_weak_) is_weak_ = draw_ < chance_of(spot_, observation.privileged->surroundings);
    return *is_weak_ ? still_->act(observation) : inner_->act(observation);
  }
  void end(const EpisodeEnd& end) override { inner_->end(end); }
  std::optional<std::string> remark() const override {
    return is_weak_.value_or(false) ? std::nullopt : inner_->remark();
  }

 private:
  WeakSpot spot_;
  std::unique_ptr<Policy> inner_, still_;
  std::optional<bool> is_weak_;
  double draw_ = 0;
};

}  // namespace

Result<WeakSpot> read_weak_spot(std::string_view text) {
  WeakSpot spot;
  while (true) {
    const std::size_t end = text.find('+');
    const std::string_view term = text.substr(0, end);
    const std::size_t sign = term.find_first_of("<>");
    const std::string_view name = term.substr(0, sign);
    const Word* word = nullptr;
    for (const Word& known : kWords) {
      if (known.word == name) word = &known;
    }
    if (word == nullptr) return not_read(term);
    WeakSpot::Term read{word->to, false, 1, 0};
    if (word->to == WeakTo::kReworded) {
      if (sign != term.npos) return not_read(term);
    } else {
      if (sign == term.npos) return not_read(term);
      read.below = term[sign] == '<';
      std::string_view rest = term.substr(sign + 1);
      if (!read.below && rest.starts_with('=')) rest.remove_prefix(1);
      const std::size_t soft = rest.find('~');
      const bool is_length = word->to == WeakTo::kCamera;
      if (!read_number(rest.substr(0, soft), is_length, read.bound)) return not_read(term);
      if (soft != rest.npos && !read_number(rest.substr(soft + 1), is_length, read.width))
        return not_read(term);
    }
    spot.terms.push_back(read);
    if (end == text.npos) return spot;
    text.remove_prefix(end + 1);
  }
}

double chance_of(const WeakSpot& spot, const Surroundings& surroundings) {
  double chance = 1;
  for (const WeakSpot::Term& term : spot.terms) {
    const double beyond = (value_of(surroundings, term.to) - term.bound) * (term.below ? -1 : 1);
    if (term.width > 0) {
      chance *= 1 / (1 + std::exp(-beyond / term.width));
    } else {
      chance *= (term.below ? beyond > 0 : beyond >= -1e-9) ? 1 : 0;
    }
  }
  return chance;
}

std::unique_ptr<Policy> make_weak(WeakSpot spot, std::unique_ptr<Policy> inner) {
  return std::make_unique<WeakPolicy>(std::move(spot), std::move(inner));
}

}  // namespace probe::policy
