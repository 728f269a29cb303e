// Private to sim: the factories of the sensor models, one for each file of this folder, for registry.cpp.
#pragma once

#include <memory>

#include "sim/sensor_model.hpp"

namespace binpick {

std::unique_ptr<SensorModel> make_active_stereo_sensor();
std::unique_ptr<SensorModel> make_ideal_sensor();
std::unique_ptr<SensorModel> make_gauss_z_sensor();
std::unique_ptr<SensorModel> make_disparity_sensor();
std::unique_ptr<SensorModel> make_structured_light_sensor();

/// Checks shared by the models; throws SpecError that names the model.
void check_depth_range(const char* model, double z_min, double z_max);
void check_between(const char* model, const char* key, double value, double low, double high);

}  // namespace binpick
