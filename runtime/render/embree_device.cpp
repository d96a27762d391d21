#include "runtime/render/embree_device.h"

#include <mutex>

namespace probe::render {
namespace {

// Embree calls back on the thread that erred; its text is kept there until check().
std::string& last_message() {
  thread_local std::string message;
  return message;
}

void keep_message(void*, RTCError, const char* text) {
  last_message() = text == nullptr ? "" : text;
}

}  // namespace

Result<std::shared_ptr<EmbreeDevice>> EmbreeDevice::shared() {
  static std::mutex mutex;
  static std::weak_ptr<EmbreeDevice> current;
  const std::scoped_lock lock(mutex);
  if (auto device = current.lock()) return device;
  RTCDevice handle = rtcNewDevice("threads=1");
  if (handle == nullptr) {
    return Failure{.code = "render",
                   .message = "Embree does not start (error " +
                              std::to_string(rtcGetDeviceError(nullptr)) + ")",
                   .where = ""};
  }
  rtcSetDeviceErrorFunction(handle, keep_message, nullptr);
  std::shared_ptr<EmbreeDevice> device(new EmbreeDevice(handle));
  current = device;
  return device;
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(device_); }

Status EmbreeDevice::check(const std::string& doing) const {
  const RTCError error = rtcGetDeviceError(device_);
  if (error == RTC_ERROR_NONE) return {};
  return Failure{.code = "render",
                 .message = doing + " failed in Embree: " + last_message() + " (error " +
                            std::to_string(error) + ")",
                 .where = ""};
}

}  // namespace probe::render
