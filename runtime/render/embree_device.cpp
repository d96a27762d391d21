#include "runtime/render/embree_device.h"

#include <mutex>

#include "runtime/render/renderer.h"

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
  // Never released: Embree starts a thread for that, and ends the program where the system has none.
  static auto* const current = new std::shared_ptr<EmbreeDevice>();
  const std::scoped_lock lock(mutex);
  if (*current) return *current;
  RTCDevice handle = rtcNewDevice("threads=1");
  if (handle == nullptr) {
    return Failure{.code = Fault::kRender,
                   .message = "Embree does not start (error " +
                              std::to_string(rtcGetDeviceError(nullptr)) + ")",
                   .where = ""};
  }
  rtcSetDeviceErrorFunction(handle, keep_message, nullptr);
  std::shared_ptr<EmbreeDevice> device(new EmbreeDevice(handle));
  *current = device;
  return device;
}

Result<std::string> describe_ray_engine() {
  PROBE_ASSIGN(const auto device, EmbreeDevice::shared());
  const auto property = [&device](RTCDeviceProperty which) {
    return rtcGetDeviceProperty(device->get(), which);
  };
  const auto version = property(RTC_DEVICE_PROPERTY_VERSION);  // 31305 is 3.13.5
  std::string text = "Embree " + std::to_string(version / 10000) + "." +
                     std::to_string(version / 100 % 100) + "." + std::to_string(version % 100) +
                     ", packets of";
  if (property(RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED) != 0) text += " 4";
  if (property(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0) text += " 8";
  if (property(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0) text += " 16";
  return text;
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(device_); }

Status EmbreeDevice::check(const std::string& doing) const {
  const RTCError error = rtcGetDeviceError(device_);
  if (error == RTC_ERROR_NONE) return {};
  return Failure{.code = Fault::kRender,
                 .message = doing + " failed in Embree: " + last_message() + " (error " +
                            std::to_string(error) + ")",
                 .where = ""};
}

}  // namespace probe::render
