#include "runtime/scene/mesh_bytes.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace probe::scene {
namespace {

class Packer {
 public:
  explicit Packer(const ByteSink& sink) : sink_(sink) {}
  template <typename T>
  void value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <typename T>
  void array(const T& values) {
    value(static_cast<std::uint64_t>(values.size()));
    bytes(reinterpret_cast<const char*>(values.data()),
          sizeof(typename T::value_type) * values.size());
  }
  bool is_good() const { return good_; }

 private:
  void bytes(const char* data, std::size_t size) {
    good_ = good_ && (size == 0 || sink_({data, size}));
  }
  const ByteSink& sink_;
  bool good_ = true;
};

// Reads what Packer wrote; false after the end.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}
  template <typename T>
  bool value(T& value) {
    if (bytes_.size() < sizeof value) return false;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return true;
  }
  template <typename T>
  bool array(T& values) {
    constexpr std::size_t kSize = sizeof(typename T::value_type);
    std::uint64_t count = 0;
    if (!value(count) || count > bytes_.size() / kSize) return false;
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), bytes_.data(), kSize * count);
    bytes_.remove_prefix(kSize * count);
    return true;
  }
  // Of things that take at least a byte each.
  bool count(std::uint64_t& count) { return value(count) && count <= bytes_.size(); }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

void pack(Packer& out, const Mesh& mesh) {
  out.array(mesh.materials);
  out.value(static_cast<std::uint64_t>(mesh.parts.size()));
  for (const MeshPart& part : mesh.parts) {
    out.value(part.material);
    out.array(part.positions);
    out.array(part.normals);
    out.array(part.uv);
    out.array(part.indices);
  }
  out.value(static_cast<std::uint64_t>(mesh.textures.size()));
  for (const Texture& texture : mesh.textures) {
    out.value(texture.width);
    out.value(texture.height);
    out.array(texture.rgba);
  }
}

bool unpack(Unpacker& in, Mesh& mesh) {
  std::uint64_t count = 0;
  if (!in.array(mesh.materials) || !in.count(count)) return false;
  mesh.parts.resize(count);
  for (MeshPart& part : mesh.parts) {
    if (!in.value(part.material) || !in.array(part.positions) || !in.array(part.normals) ||
        !in.array(part.uv) || !in.array(part.indices)) {
      return false;
    }
  }
  if (!in.count(count)) return false;
  mesh.textures.resize(count);
  for (Texture& texture : mesh.textures) {
    if (!in.value(texture.width) || !in.value(texture.height) || !in.array(texture.rgba)) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool write_mesh(const Mesh& mesh, const ByteSink& sink) {
  Packer out(sink);
  pack(out, mesh);
  return out.is_good();
}

bool read_mesh(std::string_view bytes, Mesh& mesh) {
  Unpacker in(bytes);
  return unpack(in, mesh) && in.at_end();
}

bool write_import(const Result<Mesh>& mesh, const ByteSink& sink) {
  Packer out(sink);
  out.value(mesh.ok());
  if (!mesh) {
    out.value(mesh.failure().code);
    out.array(mesh.failure().message);
    out.array(mesh.failure().where);
    return out.is_good();
  }
  out.value(static_cast<std::uint64_t>(mesh->encoded.size()));
  for (const EncodedImage& image : mesh->encoded) {
    out.array(image.bytes);
    out.array(image.mime);
  }
  pack(out, *mesh);
  return out.is_good();
}

std::optional<Result<Mesh>> read_import(std::string_view bytes) {
  Unpacker in(bytes);
  bool ok = false;
  if (!in.value(ok)) return std::nullopt;
  if (!ok) {
    Failure failure;
    if (!in.value(failure.code) || !in.array(failure.message) || !in.array(failure.where) ||
        !in.at_end()) {
      return std::nullopt;
    }
    return Result<Mesh>(std::move(failure));
  }
  Mesh mesh;
  std::uint64_t count = 0;
  if (!in.count(count)) return std::nullopt;
  mesh.encoded.resize(count);
  for (EncodedImage& image : mesh.encoded) {
    if (!in.array(image.bytes) || !in.array(image.mime)) return std::nullopt;
  }
  if (!unpack(in, mesh) || !in.at_end()) return std::nullopt;
  return Result<Mesh>(std::move(mesh));
}

}  // namespace probe::scene
