// The gripper kinds: one line each.
#include "robot/grippers/registry.hpp"

#include "core/error.hpp"
#include "core/yaml.hpp"

namespace binpick {

const std::vector<GripperEntry>& gripper_registry() {
  static const std::vector<GripperEntry> entries = {
      {"suction", "one or several vacuum cups on spring plungers", make_suction},
  };
  return entries;
}

std::vector<std::string> gripper_names() {
  std::vector<std::string> names;
  for (const GripperEntry& entry : gripper_registry()) names.push_back(entry.name);
  return names;
}

std::unique_ptr<Gripper> make_gripper(const std::string& name) {
  for (const GripperEntry& entry : gripper_registry())
    if (entry.name == name) return entry.make();
  const std::string near = nearest_name(name, gripper_names());
  throw SpecError("gripper.type: unknown gripper '" + name + "'" +
                  (near.empty() ? "" : ", did you mean '" + near + "'?"));
}

}  // namespace binpick
