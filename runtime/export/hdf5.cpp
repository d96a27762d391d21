// One HDF5 file, a group an episode. HDF5 stops here and at dataset/robomimic*.cpp.
#include <hdf5.h>

#include <array>
#include <span>

#include "runtime/export/export.h"
#include "runtime/export/hdf5_file.h"
#include "runtime/export/hdf5_handle.h"

namespace probe::exporting {
namespace {

using Handle = Hdf5Handle;
using Shape = std::vector<hsize_t>;

class Hdf5 final : public Sink {
 public:
  explicit Hdf5(Hdf5File file) : file_(std::move(file)) {}

  Status episode(const store::ResultRow& row, const store::Trace& trace) override {
    const store::TraceHeader& header = trace.header;
    const std::string name = "/" + header.task + "/" + std::to_string(header.episode) + "-" +
                             std::to_string(header.seed);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    const Handle group(H5Gcreate2(file_, name.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    ok_ = ok_ && group >= 0;
    attributes(group, row, trace);
    if (trace.start) start(group, *trace.start);
    steps(group, trace);
    contacts(group, trace);
    if (header.live) live(group, trace);
    return file_.status(ok_);
  }

  Status finish() override { return file_.close(ok_); }

 private:
  void attributes(hid_t group, const store::ResultRow& row, const store::Trace& trace) {
    const store::TraceHeader& header = trace.header;
    text(group, "task", header.task);
    text(group, "policy", header.policy);
    text(group, "prompt", header.prompt);
    if (!header.later.empty()) texts(group, "then", header.later);
    text(group, "plan_root", to_hex(header.plan_root));
    text(group, "episode_id", to_hex(header.episode_id));
    text(group, "start_id", to_hex(header.start_id));
    text(group, "trace_sha256", row.trace_sha256);
    text(group, "invalid", row.invalid.value_or(""));
    text(group, "live", header.live ? to_text(*header.live) : "");
    if (header.joint_actions) text(group, "action_law", header.joint_actions->law);
    if (header.live && header.live->delay_s) number(group, "live_delay_s", *header.live->delay_s);
    number(group, "episode", header.episode);
    number(group, "seed", header.seed);
    number(group, "horizon", header.horizon);
    number(group, "control_hz", header.control_hz);
    number(group, "idle", row.idle);
    number(group, "delay", row.delay);
    texts(group, "bodies", header.bodies);
    texts(group, "joints", header.joints);
    std::vector<std::string> names;
    for (const auto& metric : header.metrics) names.push_back(metric.name);
    texts(group, "metrics", names);
  }

  void start(hid_t group, const store::TraceStart& start) {
    std::vector<double> position, half, opening;
    for (const vm::BodyStart& body : start.starts) {
      put(position, body.position);
      put(half, body.half);
      put(opening, body.opening);
    }
    const hsize_t bodies = start.starts.size();
    reals(group, "start_q", start.q, {start.q.size()});
    reals(group, "start_position", position, {bodies, 3});
    reals(group, "start_half", half, {bodies, 3});
    reals(group, "start_opening", opening, {bodies, 3});
  }

  void steps(hid_t group, const store::Trace& trace) {
    const hsize_t n = trace.steps.size();
    const hsize_t bodies = trace.header.bodies.size(), joints = trace.header.joints.size();
    const hsize_t metric_count = trace.header.metrics.size();
    std::vector<double> step, time, grip, tcp, action, q, u, metrics, seconds;
    std::vector<double> position, origin, velocity, spin, rotation, own;
    std::vector<std::uint8_t> prompt, image, state;
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    for (const store::TraceStep& s : trace.steps) {
      step.push_back(s.sample.step);
      time.push_back(s.sample.time);
      grip.push_back(s.sample.grip);
      put(tcp, s.sample.tcp);
      append(action, s.action);
      append(q, s.q);
      append(u, s.u);
      append(metrics, s.metrics);
      append(seconds, std::array{s.render_s, s.policy_s, s.physics_s});
      append(prompt, s.prompt_hash.bytes);
      append(image, s.image_hash.bytes);
      append(state, s.state_hash.bytes);
      for (const vm::OwnPlace& place : s.sample.own) put(own, place.position);
      for (const vm::BodySample& body : s.sample.bodies) {
        put(position, body.position);
        put(origin, body.origin);
        put(velocity, body.velocity);
        put(spin, body.spin);
        const Quat& r = body.rotation;
        append(rotation, std::array{r.w(), r.x(), r.y(), r.z()});
      }
    }
    reals(group, "step", step, {n});
    reals(group, "time", time, {n});
    reals(group, "grip", grip, {n});
    reals(group, "tcp", tcp, {n, 3});
    reals(group, "action", action, {n, trace.header.action_size()});
    reals(group, "q", q, {n, joints});
    reals(group, "u", u, {n, joints});
    reals(group, "metrics", metrics, {n, metric_count});
    reals(group, "seconds", seconds, {n, 3});
    reals(group, "body_position", position, {n, bodies, 3});
    reals(group, "body_origin", origin, {n, bodies, 3});
    reals(group, "body_velocity", velocity, {n, bodies, 3});
    reals(group, "body_spin", spin, {n, bodies, 3});
    reals(group, "body_rotation", rotation, {n, bodies, 4});
    // What moves by itself is the same in every step.
    if (!own.empty()) {
      std::vector<double> bodies_of_own;
      for (const vm::OwnPlace& place : trace.steps.front().sample.own)
        bodies_of_own.push_back(place.body);
      const hsize_t movers = bodies_of_own.size();
      reals(group, "own_place_body", bodies_of_own, {movers});
      reals(group, "own_place", own, {n, movers, 3});
    }
    bytes(group, "prompt_sha256", prompt, {n, 32});
    bytes(group, "image_sha256", image, {n, 32});
    bytes(group, "state_hash", state, {n, 32});
  }

  // Steps have different numbers of contacts, so these are rows of their own.
  void contacts(hid_t group, const store::Trace& trace) {
    std::vector<double> step, push;
    std::vector<std::uint16_t> pairs;
    for (const store::TraceStep& s : trace.steps) {
      for (const vm::ContactSample& contact : s.sample.contacts) {
        step.push_back(s.sample.step);
        pairs.push_back(contact.a);
        pairs.push_back(contact.b);
        put(push, contact.push);
      }
    }
    const hsize_t n = step.size();
    reals(group, "contact_step", step, {n});
    dataset(group, "contact_bodies", H5T_STD_U16LE, H5T_NATIVE_UINT16, pairs.data(), pairs.size(),
            {n, 2});
    reals(group, "contact_push", push, {n, 3});
  }

  // Of a world that does not wait; answers are rows of their own, as a step has several or none.
  void live(hid_t group, const store::Trace& trace) {
    std::vector<std::uint8_t> source, asks;
    std::vector<double> step, asked, steps_late, seconds;
    for (std::size_t i = 0; i < trace.steps.size(); ++i) {
      const store::TraceStep& s = trace.steps[i];
      if (!s.live) continue;  // and the shapes below do not fit
      source.push_back(static_cast<std::uint8_t>(s.live->source));
      asks.push_back(s.live->asks);
      for (const policy::LiveAnswer& answer : s.live->answers) {
        step.push_back(s.sample.step);
        asked.push_back(answer.asked);
        steps_late.push_back(static_cast<double>(i) - answer.asked);
        seconds.push_back(answer.answer_s);
      }
    }
    const hsize_t n = trace.steps.size(), answers = step.size();
    bytes(group, "live_source", source, {n});
    bytes(group, "live_asks", asks, {n});
    reals(group, "answer_step", step, {answers});
    reals(group, "answer_asked", asked, {answers});
    reals(group, "answer_delay_steps", steps_late, {answers});
    reals(group, "answer_delay_s", seconds, {answers});
  }

  static void put(std::vector<double>& to, const Vec3& v) {
    to.push_back(v.x());
    to.push_back(v.y());
    to.push_back(v.z());
  }

  void reals(hid_t group, const char* name, const std::vector<double>& values, const Shape& shape) {
    dataset(group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), values.size(), shape);
  }
  void bytes(hid_t group, const char* name, const std::vector<std::uint8_t>& values,
             const Shape& shape) {
    dataset(group, name, H5T_STD_U8LE, H5T_NATIVE_UINT8, values.data(), values.size(), shape);
  }

  void dataset(hid_t group, const char* name, hid_t stored, hid_t given, const void* values,
               std::size_t count, const Shape& shape) {
    hsize_t wanted = 1;
    for (const hsize_t side : shape) wanted *= side;
    if (wanted != count) ok_ = false;  // a trace whose steps do not have what its header names
    if (!ok_) return;
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties, false);  // equal traces make equal files
    if (count > 0) {
      H5Pset_chunk(properties, static_cast<int>(shape.size()), shape.data());
      H5Pset_shuffle(properties);
      if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) H5Pset_deflate(properties, 4);
    }
    const Handle set(H5Dcreate2(group, name, stored, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                     H5Dclose);
    ok_ = set >= 0;
    if (ok_ && count > 0) ok_ = H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  }

  void text(hid_t group, const char* name, const std::string& value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    strings(group, name, space, {&value, 1});
  }
  void texts(hid_t group, const char* name, const std::vector<std::string>& values) {
    const hsize_t count = values.size();
    const Handle space(count == 0 ? H5Screate(H5S_NULL) : H5Screate_simple(1, &count, nullptr),
                       H5Sclose);
    strings(group, name, space, values);
  }
  void strings(hid_t group, const char* name, hid_t space, std::span<const std::string> values) {
    if (!ok_) return;
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const Handle attribute(H5Acreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    ok_ = attribute >= 0;
    std::vector<const char*> pointers;
    for (const std::string& value : values) pointers.push_back(value.c_str());
    if (ok_ && !pointers.empty()) ok_ = H5Awrite(attribute, type, pointers.data()) >= 0;
  }
  void number(hid_t group, const char* name, double value) {
    if (!ok_) return;
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(group, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    ok_ = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;
  }

  Hdf5File file_;
  bool ok_ = true;
};

}  // namespace

Result<std::unique_ptr<Sink>> open_hdf5(const std::string& path) {
  PROBE_ASSIGN(Hdf5File file, Hdf5File::create(path));
  return std::unique_ptr<Sink>(std::make_unique<Hdf5>(std::move(file)));
}

}  // namespace probe::exporting
