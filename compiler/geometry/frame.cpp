#include "compiler/geometry/frame.h"

#include "compiler/geometry/camera_pose.h"
#include "compiler/geometry/pose.h"

namespace probe::sema {

Frame frame_of(const Model& model, const Scene& scene, const Camera& camera) {
  const Pose base = pose_of(scene.base_position, scene.base_turn.rotation);
  Frame frame;
  frame.base = base.position;
  frame.ahead = base.rotation * Vec3::UnitX();
  frame.left = base.rotation * Vec3::UnitY();
  // What is left in one start need not be so in the next: programs have one camera for all.
  frame.jitters = camera.jitters();
  if (frame.jitters) return frame;
  const auto pose = camera_pose(model, scene, camera);
  if (!pose) return frame;
  Sight sight;
  sight.eye = pose->position;
  sight.forward = pose->rotation * Vec3::UnitX();
  sight.right = pose->rotation * -Vec3::UnitY();
  if (camera.sensor.mirrored != 0) sight.right = -sight.right;  // of the picture that is seen
  sight.down = pose->rotation * -Vec3::UnitZ();
  const Vec3 middle((scene.area[0] + scene.area[2]) / 2, (scene.area[1] + scene.area[3]) / 2,
                    scene.surface_z);
  sight.middle = middle;
  // Towards the camera, also of one that looks straight down or along the ground.
  sight.near = sight.down - sight.forward;
  sight.near.z() = 0;
  sight.near.normalize();
  sight.depth = sight.forward.dot(middle - sight.eye);
  if (sight.depth > 1e-3) frame.sight = sight;
  return frame;
}

}  // namespace probe::sema
