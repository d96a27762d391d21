#include "runtime/world/snapshot.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/world/colliders.h"

namespace probe::world {
namespace {

using std::size_t;

static_assert(std::endian::native == std::endian::little,
              "states are written as they lie in memory");
constexpr std::uint32_t kMagic = 0x33535756;  // VWS3

// Of a body, whether it is led; the last goes on with where it was let go.
constexpr std::uint8_t kNeverLed = 0, kIsLed = 1, kWasLetGo = 2;

class Writer {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    const size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  void put(const Vec3& v) {
    for (int k = 0; k < 3; ++k) put(v[k]);
  }
  void put(const Quat& q) {
    for (int k = 0; k < 4; ++k) put(q.coeffs()[k]);
  }
  void put(const Mat3& m) {
    for (int c = 0; c < 3; ++c) put(Vec3(m.col(c)));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <typename T>
  void get(T* value) {
    static_assert(std::is_arithmetic_v<T>);
    if (bytes_.size() - at_ < sizeof *value) {
      good_ = false;
      *value = T{};
      return;
    }
    std::memcpy(value, bytes_.data() + at_, sizeof *value);
    at_ += sizeof *value;
  }
  void get(bool* value) {
    std::uint8_t byte = 0;
    get(&byte);
    if (byte > 1) good_ = false;
    *value = byte == 1;
  }
  void get(Vec3* v) {
    for (int k = 0; k < 3; ++k) get(&(*v)[k]);
  }
  void get(Quat* q) {
    for (int k = 0; k < 4; ++k) get(&q->coeffs()[k]);
  }
  void get(Mat3* m) {
    for (int c = 0; c < 3; ++c) {
      Vec3 column;
      get(&column);
      m->col(c) = column;
    }
  }
  bool good() const { return good_; }
  bool at_end() const { return good_ && at_ == bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  size_t at_ = 0;
  bool good_ = true;
};

// One list of fields for both directions.
template <typename Stream>
void point_fields(Stream&& s, auto& point) {
  s(point.anchor_a), s(point.anchor_b), s(point.normal_a), s(point.id);
  s(point.normal_impulse), s(point.torsion_impulse), s(point.friction_impulse);
}

template <typename Stream>
void body_fields(Stream&& s, auto& body) {
  s(body.position), s(body.rotation), s(body.velocity), s(body.spin), s(body.calm), s(body.asleep);
}

template <typename Stream>
void joint_fields(Stream&& s, auto& joints) {
  for (size_t j = 0; j < kMaxJoints; ++j) {
    s(joints.q[j]), s(joints.u[j]), s(joints.target[j]);
    s(joints.limit_impulse[j][0]), s(joints.limit_impulse[j][1]), s(joints.friction_impulse[j]);
    s(joints.saturated[j]);
  }
}

template <typename Stream>
void record_fields(Stream&& s, auto& record) {
  s(record.frozen), s(record.count), s(record.axes), s(record.offset), s(record.impulse);
}

// Of a saved count of substeps at rest: what is counted on from there cannot overflow.
bool is_calm_count(int calm) { return calm >= 0 && calm < 1'000'000'000; }

bool is_kept(const PairRecord& record, std::uint64_t next_substep) {
  return record.valid && (record.frozen || record.last + 1 == next_substep);
}

}  // namespace

std::vector<std::byte> save_state(const Stepper& stepper) {
  Writer out;
  const auto put = [&](const auto& value) { out.put(value); };
  out.put(kMagic);
  out.put(static_cast<std::uint32_t>(stepper.drives.count));
  out.put(static_cast<std::uint32_t>(stepper.articulations.size()));
  out.put(static_cast<std::uint32_t>(stepper.bodies.size()));
  out.put(static_cast<std::uint32_t>(stepper.table.pairs.size()));
  out.put(stepper.substep);
  out.put(stepper.ambient.tilt_locked);
  joint_fields(put, stepper.joints);
  for (const Articulation& a : stepper.articulations) out.put(a.calm), out.put(a.asleep);
  for (const Body& body : stepper.bodies) body_fields(put, body);
  std::uint32_t kept = 0;
  for (const ColliderPair& pair : stepper.table.pairs) {
    for (const ColliderPair::Entry& entry : pair.near) {
      kept += is_kept(stepper.table.record(entry.record), stepper.substep) ? 1 : 0;
    }
  }
  out.put(kept);
  for (size_t p = 0; p < stepper.table.pairs.size(); ++p) {
    for (const ColliderPair::Entry& entry : stepper.table.pairs[p].near) {
      const PairRecord& record = stepper.table.record(entry.record);
      if (!is_kept(record, stepper.substep)) continue;
      out.put(static_cast<std::uint32_t>(p));
      out.put(entry.key);
      record_fields(put, record);
      for (size_t k = 0; k < static_cast<size_t>(record.count); ++k)
        point_fields(put, record.points[k]);
    }
  }
  // States of worlds in which nobody is or was led are as they ever were.
  const auto was_let_go = [](const Body& body) { return body.let_go_at.has_value(); };
  if (std::ranges::any_of(stepper.bodies, &Body::led) ||
      std::ranges::any_of(stepper.bodies, was_let_go)) {
    for (const Body& body : stepper.bodies) {
      out.put(body.led ? kIsLed : was_let_go(body) ? kWasLetGo : kNeverLed);
      if (was_let_go(body)) out.put(*body.let_go_at);
    }
  }
  return out.take();
}

Status restore_state(std::span<const std::byte> bytes, Stepper* stepper) {
  Reader in(bytes);
  const auto get = [&](auto& value) { in.get(&value); };
  std::uint32_t magic = 0, joint_count = 0, articulation_count = 0, body_count = 0;
  std::uint32_t pair_count = 0, kept = 0;
  std::uint64_t substep = 0;
  bool tilt_locked = false;
  get(magic), get(joint_count), get(articulation_count), get(body_count), get(pair_count);
  get(substep), get(tilt_locked);
  if (!in.good() || magic != kMagic)
    return Failure{Fault::kWorld, "the bytes are not a saved world", ""};
  std::vector<ColliderPair>& pairs = stepper->table.pairs;
  if (joint_count != static_cast<std::uint32_t>(stepper->drives.count) ||
      articulation_count != stepper->articulations.size() || body_count != stepper->bodies.size() ||
      pair_count != pairs.size()) {
    return Failure{Fault::kWorld,
                   "the saved state is of a world with other joints, bodies or shapes", ""};
  }
  Joints joints;
  joint_fields(get, joints);
  struct Rest {
    int calm = 0;
    bool asleep = false;
  };
  std::vector<Rest> rests(articulation_count);
  for (Rest& rest : rests) get(rest.calm), get(rest.asleep);
  std::vector<Body> bodies = stepper->bodies;
  for (Body& body : bodies) {
    body_fields(get, body);
    body.axes = body.rotation.toRotationMatrix();
  }
  const auto counts = [](const auto& of) { return is_calm_count(of.calm); };
  if (!std::ranges::all_of(rests, counts) || !std::ranges::all_of(bodies, counts)) {
    return Failure{Fault::kWorld, "the saved state has a time at rest that cannot be", ""};
  }
  get(kept);
  struct Kept {
    std::uint32_t pair = 0, key = 0;
    PairRecord record;
  };
  std::vector<Kept> records;
  for (std::uint32_t n = 0; n < kept && in.good(); ++n) {
    Kept& saved = records.emplace_back();
    PairRecord& record = saved.record;
    get(saved.pair), get(saved.key);
    if (saved.pair >= pairs.size() || saved.key >= pairs[saved.pair].keys) {
      return Failure{Fault::kWorld, "the saved state names a pair that is not there", ""};
    }
    record_fields(get, record);
    if (record.count < 0 || record.count > kMaxPoints) {
      return Failure{Fault::kWorld, "the saved state has a pair with too many points", ""};
    }
    for (size_t k = 0; k < static_cast<size_t>(record.count); ++k)
      point_fields(get, record.points[k]);
    record.valid = true;
    record.last = substep - 1;
  }
  const bool has_led = !in.at_end();
  for (Body& body : bodies) {
    body.led = false;
    body.let_go_at.reset();
    if (!has_led) continue;
    std::uint8_t leading = kNeverLed;
    get(leading);
    if (leading > kWasLetGo)
      return Failure{Fault::kWorld, "the saved state has a body that is led in no known way", ""};
    body.led = leading == kIsLed;
    if (leading == kWasLetGo) get(body.let_go_at.emplace());
  }
  if (!in.at_end()) {
    return Failure{Fault::kWorld, "the saved state is cut short or has bytes left over", ""};
  }

  stepper->substep = substep;
  stepper->ambient.tilt_locked = tilt_locked;
  stepper->joints = joints;
  stepper->bodies = std::move(bodies);
  stepper->table.clear();
  for (const Kept& saved : records) {
    const std::uint32_t index = stepper->table.find_or_add(&pairs[saved.pair], saved.key);
    stepper->table.record(index) = saved.record;
  }
  for (size_t a = 0; a < rests.size(); ++a) {
    Articulation& articulation = stepper->articulations[a];
    articulation.calm = rests[a].calm;
    articulation.asleep = rests[a].asleep;
    articulation.tree->update(joints.q);
    place_links(articulation, joints.u, &stepper->colliders);
  }
  for (size_t b = 0; b < stepper->bodies.size(); ++b) {
    place_body(stepper->bodies[b], &stepper->colliders[stepper->links + b]);
  }
  return {};
}

Sha256 hash_state(const Stepper& stepper) {
  Hasher hasher;
  const size_t n = static_cast<size_t>(stepper.drives.count);
  hasher.u32(static_cast<std::uint32_t>(n)).u32(static_cast<std::uint32_t>(stepper.bodies.size()));
  for (const JointArray* values : {&stepper.joints.q, &stepper.joints.u, &stepper.joints.target}) {
    hasher.f64s(std::span(values->data(), n));
  }
  for (const Body& body : stepper.bodies) {
    hasher.f64s(std::span(body.position.data(), 3))
        .f64s(std::span(body.rotation.coeffs().data(), 4));
    hasher.f64s(std::span(body.velocity.data(), 3)).f64s(std::span(body.spin.data(), 3));
  }
  return hasher.finish();
}

}  // namespace probe::world
