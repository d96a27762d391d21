#include "runtime/export/dataset/robomimic_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>

#include "runtime/base/bytes.h"
#include "runtime/export/hdf5_handle.h"

namespace probe::dataset {
namespace {

// Of pictures that one process reads: some seconds of unpacking at most.
constexpr std::size_t kMostPictures = std::size_t{128} << 20;

// ---- in the process of its own

using Id = exporting::Hdf5Handle;
using Sides = std::vector<hsize_t>;

Failure unreadable(const std::string& what, const std::string& where) {
  return {Fault::kIo, what + " cannot be read", where};
}

Sides sides_of(hid_t set) {
  const Id space(H5Dget_space(set), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  Sides sides(rank > 0 ? static_cast<std::size_t>(rank) : 0);
  if (rank > 0) H5Sget_simple_extent_dims(space, sides.data(), nullptr);
  return sides;
}

// Numbers of a dataset of exactly these sides.
template <typename T>
Result<std::vector<T>> numbers(hid_t parent, const char* called, hid_t type, const Sides& wanted,
                               const std::string& where) {
  const Id set(H5Dopen2(parent, called, H5P_DEFAULT), H5Dclose);
  if (set < 0) return unreadable(called, where);
  if (sides_of(set) != wanted)
    return Failure{Fault::kIo, std::string(called) + " has another shape than its trace", where};
  hsize_t count = 1;
  for (const hsize_t side : wanted) count *= side;
  std::vector<T> values(count);
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    return unreadable(called, where);
  return values;
}

Result<std::int64_t> whole(hid_t parent, const char* called, const std::string& where) {
  const Id attribute(H5Aopen(parent, called, H5P_DEFAULT), H5Aclose);
  std::int64_t value = 0;
  if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0)
    return unreadable(called, where);
  return value;
}

Result<std::string> text(hid_t parent, const char* called, const std::string& where) {
  const Id attribute(H5Aopen(parent, called, H5P_DEFAULT), H5Aclose);
  const Id stored(attribute < 0 ? H5I_INVALID_HID : H5Aget_type(attribute), H5Tclose);
  if (stored < 0 || H5Tis_variable_str(stored) <= 0) return unreadable(called, where);
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5Tget_cset(stored));
  char* words = nullptr;
  if (H5Aread(attribute, type, &words) < 0 || words == nullptr) return unreadable(called, where);
  const Id space(H5Aget_space(attribute), H5Sclose);
  std::string copy = words;
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, &words);
  return copy;
}

// Names of a list of bytes of one length, padded with zeros; none where the list is not there.
std::vector<std::string> names(hid_t parent, const char* called) {
  std::vector<std::string> all;
  if (H5Lexists(parent, called, H5P_DEFAULT) <= 0) return all;
  const Id set(H5Dopen2(parent, called, H5P_DEFAULT), H5Dclose);
  const Id type(set < 0 ? H5I_INVALID_HID : H5Dget_type(set), H5Tclose);
  if (type < 0 || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return all;
  const Sides sides = sides_of(set);
  const std::size_t length = H5Tget_size(type);
  std::string bytes(sides.empty() ? 0 : sides[0] * length, '\0');
  if (bytes.empty() || H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
    return all;
  for (std::size_t i = 0; i < bytes.size(); i += length)
    all.emplace_back(bytes.substr(i, length).c_str());
  return all;
}

Result<std::vector<double>> reals(hid_t parent, const char* called, const Sides& sides,
                                  const std::string& where) {
  return numbers<double>(parent, called, H5T_NATIVE_DOUBLE, sides, where);
}

Id open_file(const std::string& path) {
  // Failures are told by us, not by the library's own printing.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
}

void write_list(const std::vector<std::string>& list, ByteWriter* out) {
  out->u32(static_cast<std::uint32_t>(list.size()));
  for (const std::string& item : list) out->text(item);
}

Status write_head(hid_t file, const std::string& path, ByteWriter* out) {
  const Id data(H5Gopen2(file, "data", H5P_DEFAULT), H5Gclose);
  H5G_info_t held{};
  if (data < 0 || H5Gget_info(data, &held) < 0) return unreadable("data", path);
  out->u64(held.nlinks);
  PROBE_ASSIGN(const std::int64_t total, whole(data, "total", path));
  out->u64(static_cast<std::uint64_t>(total));
  PROBE_ASSIGN(const std::string env, text(data, "env_args", path));
  out->text(env);
  const Id mask(H5Gopen2(file, "mask", H5P_DEFAULT), H5Gclose);
  out->u8(mask < 0 ? 0 : 1);
  for (const char* list : {"success", "failure", "train"})
    write_list(mask < 0 ? std::vector<std::string>() : names(mask, list), out);
  return {};
}

Status write_demo(hid_t file, const std::string& name, const RobomimicSides& sides,
                  const std::string& where, ByteWriter* out) {
  const Id demo(H5Gopen2(file, ("data/" + name).c_str(), H5P_DEFAULT), H5Gclose);
  if (demo < 0) return Failure{Fault::kIo, "is not there", where};
  const Id obs(H5Gopen2(demo, "obs", H5P_DEFAULT), H5Gclose);
  if (obs < 0) return unreadable("obs", where);
  const hsize_t n = sides.steps, joints = sides.joints;
  PROBE_ASSIGN(const auto samples, whole(demo, "num_samples", where));
  out->u64(static_cast<std::uint64_t>(samples));
  PROBE_ASSIGN(const auto actions, reals(demo, "actions", {n, sides.action}, where));
  PROBE_ASSIGN(const auto rewards, reals(demo, "rewards", {n}, where));
  PROBE_ASSIGN(const auto states, reals(demo, "states", {n, joints}, where));
  PROBE_ASSIGN(const auto state, reals(obs, "state", {n, kStateSize}, where));
  PROBE_ASSIGN(const auto turned, reals(obs, "joints", {n, joints}, where));
  for (const auto* all : {&actions, &rewards, &states, &state, &turned}) out->reals(*all);
  PROBE_ASSIGN(const auto dones,
               numbers<std::int64_t>(demo, "dones", H5T_NATIVE_INT64, {n}, where));
  for (const std::int64_t done : dones) out->u64(static_cast<std::uint64_t>(done));
  PROBE_ASSIGN(const std::string meta, text(demo, "ep_meta", where));
  out->text(meta);
  return {};
}

std::size_t size_of(const CameraShape& camera) {
  return std::size_t{3} * static_cast<std::size_t>(camera.width) *
         static_cast<std::size_t>(camera.height);
}

// Which steps of which demonstration.
struct Stretch {
  std::string name;
  std::span<const CameraShape> cameras;
  std::size_t steps = 0, first = 0, count = 0;
};

Status write_pictures(hid_t file, const Stretch& asked, const std::string& where,
                      const AnswerWriter& write) {
  const Id obs(H5Gopen2(file, ("data/" + asked.name + "/obs").c_str(), H5P_DEFAULT), H5Gclose);
  if (obs < 0) return unreadable("obs", where);
  std::vector<std::unique_ptr<Id>> sets;
  for (const CameraShape& camera : asked.cameras) {
    sets.push_back(std::make_unique<Id>(H5Dopen2(obs, camera.name.c_str(), H5P_DEFAULT), H5Dclose));
    if (*sets.back() < 0) return unreadable("obs/" + camera.name, where);
    const Sides sides = {asked.steps, static_cast<hsize_t>(camera.height),
                         static_cast<hsize_t>(camera.width), 3};
    if (sides_of(*sets.back()) != sides)
      return Failure{Fault::kIo, "obs/" + camera.name + " has another shape than the dataset's",
                     where};
  }
  for (std::size_t i = asked.first; i < asked.first + asked.count; ++i) {
    for (std::size_t c = 0; c < sets.size(); ++c) {
      const CameraShape& camera = asked.cameras[c];
      const hsize_t from[] = {i, 0, 0, 0};
      const hsize_t count[] = {1, static_cast<hsize_t>(camera.height),
                               static_cast<hsize_t>(camera.width), 3};
      const Id space(H5Dget_space(*sets[c]), H5Sclose);
      const Id memory(H5Screate_simple(4, count, nullptr), H5Sclose);
      H5Sselect_hyperslab(space, H5S_SELECT_SET, from, nullptr, count, nullptr);
      std::string rgb(size_of(camera), '\0');
      if (H5Dread(*sets[c], H5T_NATIVE_UINT8, memory, space, H5P_DEFAULT, rgb.data()) < 0)
        return unreadable(fmt::format("picture {} of obs/{}", i, camera.name), where);
      if (!write(rgb)) return unreadable(fmt::format("picture {}", i), where);
    }
  }
  return {};
}

// ---- between the two: what was read and kRead; or, behind whatever was read, message, place, the
// size of both, and kFailed

constexpr char kRead = 1, kFailed = 0;

std::string_view as_text(const ByteWriter& bytes) {
  return {reinterpret_cast<const char*>(bytes.bytes().data()), bytes.bytes().size()};
}

std::string_view without_end(std::string_view bytes, std::size_t end) {
  return bytes.substr(0, bytes.size() - std::min(end, bytes.size()));
}

Failure half(const std::string& where) {
  return {Fault::kIo, "makes its reader give half an answer", where};
}

Failure read_failure(std::string_view answer, const std::string& where) {
  constexpr std::size_t kSize = sizeof(std::uint64_t);
  const std::string_view all = without_end(answer, 1), said = without_end(all, kSize);
  const std::uint64_t size = ByteReader(std::as_bytes(std::span(all.substr(said.size())))).u64();
  if (size > said.size()) return half(where);
  ByteReader in(std::as_bytes(std::span(said.substr(said.size() - size))));
  std::string message = in.text(), place = in.text();
  if (!in.ok()) return half(where);
  return {Fault::kIo, std::move(message), std::move(place)};
}

// What `read` writes; its failures, and what ended it, with `where`.
Result<Answer> apart(const std::string& path, const std::string& where,
                     const std::function<Status(hid_t, const AnswerWriter&)>& read) {
  const auto work = [&](const AnswerWriter& write) {
    const Id file = open_file(path);
    const Status status =
        file < 0 ? Status(Failure{Fault::kIo, "is no HDF5 file that can be read", path})
                 : read(file, write);
    if (status) return write({&kRead, 1});
    ByteWriter said, size;
    said.text(status.failure().message);
    said.text(status.failure().where);
    size.u64(said.bytes().size());
    return write(as_text(said)) && write(as_text(size)) && write({&kFailed, 1});
  };
  auto answer = run_apart(work);
  if (!answer) return Failure{Fault::kIo, answer.failure().message, where};
  if (answer->bytes().empty()) return half(where);
  if (answer->bytes().back() == kRead) return answer;
  return read_failure(answer->bytes(), where);
}

// As apart, for what is written as values.
Result<Answer> values_apart(const std::string& path, const std::string& where,
                            const std::function<Status(hid_t, ByteWriter*)>& read) {
  return apart(path, where, [&](hid_t file, const AnswerWriter& write) -> Status {
    ByteWriter out;
    PROBE_TRY(read(file, &out));
    if (!write(as_text(out))) return unreadable("as much as that", where);
    return {};
  });
}

ByteReader values_of(const Answer& answer) {
  return ByteReader(std::as_bytes(std::span(without_end(answer.bytes(), 1))));
}

std::vector<std::string> read_list(ByteReader* in) {
  std::vector<std::string> list(in->count(in->u32(), sizeof(std::uint32_t)));
  for (std::string& item : list) item = in->text();
  return list;
}

}  // namespace

std::vector<std::span<const std::uint8_t>> RobomimicPictures::step(std::size_t i) const {
  const auto* rgb = reinterpret_cast<const std::uint8_t*>(bytes_.bytes().data());
  rgb += i * std::accumulate(sizes_.begin(), sizes_.end(), std::size_t{0});
  std::vector<std::span<const std::uint8_t>> pictures;
  for (const std::size_t size : sizes_) {
    pictures.emplace_back(rgb, size);
    rgb += size;
  }
  return pictures;
}

Status RobomimicFile::open() const {
  const auto answer = apart(path_, path_, [](hid_t, const AnswerWriter&) { return Status(); });
  return answer ? Status() : Status(answer.failure());
}

Result<RobomimicHead> RobomimicFile::head() const {
  PROBE_ASSIGN(const Answer answer, values_apart(path_, path_, [&](hid_t file, ByteWriter* out) {
                 return write_head(file, path_, out);
               }));
  ByteReader in = values_of(answer);
  RobomimicHead head;
  head.demonstrations = in.u64();
  head.total = static_cast<std::int64_t>(in.u64());
  head.env_args = in.text();
  head.has_mask = in.u8() == 1;
  for (auto* list : {&head.success, &head.failure, &head.train}) *list = read_list(&in);
  if (!in.ok()) return half(path_);
  return head;
}

Result<RobomimicDemo> RobomimicFile::demo(const std::string& name, const RobomimicSides& sides,
                                          const std::string& where) const {
  PROBE_ASSIGN(const Answer answer, values_apart(path_, where, [&](hid_t file, ByteWriter* out) {
                 return write_demo(file, name, sides, where, out);
               }));
  ByteReader in = values_of(answer);
  RobomimicDemo demo;
  demo.samples = static_cast<std::int64_t>(in.u64());
  for (auto* all : {&demo.actions, &demo.rewards, &demo.states, &demo.state, &demo.joints})
    *all = in.reals();
  demo.dones.resize(in.count(sides.steps, sizeof(std::int64_t)));
  for (std::int64_t& done : demo.dones) done = static_cast<std::int64_t>(in.u64());
  demo.meta = in.text();
  const bool is_whole = demo.actions.size() == sides.steps * sides.action &&
                        demo.rewards.size() == sides.steps &&
                        demo.states.size() == sides.steps * sides.joints &&
                        demo.state.size() == sides.steps * kStateSize &&
                        demo.joints.size() == sides.steps * sides.joints;
  if (!in.ok() || !is_whole) return half(where);
  return demo;
}

Result<RobomimicPictures> RobomimicFile::pictures(const std::string& name,
                                                  std::span<const CameraShape> cameras,
                                                  std::size_t steps, std::size_t first,
                                                  const std::string& where) const {
  std::vector<std::size_t> sizes;
  for (const CameraShape& camera : cameras) sizes.push_back(size_of(camera));
  const std::size_t size = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  const std::size_t most = std::max<std::size_t>(kMostPictures / std::max<std::size_t>(size, 1), 1);
  const Stretch asked{name, cameras, steps, first, std::min(most, steps - first)};
  PROBE_ASSIGN(Answer answer, apart(path_, where, [&](hid_t file, const AnswerWriter& write) {
                 return write_pictures(file, asked, where, write);
               }));
  if (answer.bytes().size() != asked.count * size + 1) return half(where);
  return RobomimicPictures(std::move(answer), asked.count, std::move(sizes));
}

}  // namespace probe::dataset
