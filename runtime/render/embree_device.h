// The process's one Embree device, with owning handles. Embree itself stays in this folder.
#pragma once

#include <embree3/rtcore.h>
#include <xmmintrin.h>

#include <memory>
#include <string>

#include "runtime/base/result.h"

namespace probe::render {

// One device a process while anybody holds it; made with one thread, since worlds bring their own.
class EmbreeDevice {
 public:
  static Result<std::shared_ptr<EmbreeDevice>> shared();
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_; }
  // Fails (kRender) if a call of this thread failed since the last check; `doing` names the
  // work.
  Status check(const std::string& doing) const;

 private:
  explicit EmbreeDevice(RTCDevice device) : device_(device) {}
  RTCDevice device_;
};

struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct GeometryDeleter {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using ScenePtr = std::unique_ptr<RTCSceneTy, SceneDeleter>;
using GeometryPtr = std::unique_ptr<RTCGeometryTy, GeometryDeleter>;

// Embree wants denormals flushed; physics on the same thread must not see that.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace probe::render
