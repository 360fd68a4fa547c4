#include "holdfast/io/ros/message_types.hpp"

#include <initializer_list>

namespace holdfast::io::ros {
namespace {

/// A message that others hold.
struct Part {
  std::string_view type;
  std::string_view fields;
};

constexpr Part kHeader{"std_msgs/Header", R"(uint32 seq
time stamp
string frame_id
)"};

constexpr Part kPointField{"sensor_msgs/PointField", R"(uint8 INT8=1
uint8 UINT8=2
uint8 INT16=3
uint8 UINT16=4
uint8 INT32=5
uint8 UINT32=6
uint8 FLOAT32=7
uint8 FLOAT64=8
string name
uint32 offset
uint8 datatype
uint32 count
)"};

constexpr Part kQuaternion{"geometry_msgs/Quaternion", R"(float64 x
float64 y
float64 z
float64 w
)"};

constexpr Part kVector3{"geometry_msgs/Vector3", R"(float64 x
float64 y
float64 z
)"};

constexpr Part kPoseWithCovariance{"geometry_msgs/PoseWithCovariance", R"(geometry_msgs/Pose pose
float64[36] covariance
)"};

constexpr Part kPose{"geometry_msgs/Pose", R"(geometry_msgs/Point position
geometry_msgs/Quaternion orientation
)"};

constexpr Part kPoint{"geometry_msgs/Point", R"(float64 x
float64 y
float64 z
)"};

constexpr Part kTwistWithCovariance{"geometry_msgs/TwistWithCovariance",
                                    R"(geometry_msgs/Twist twist
float64[36] covariance
)"};

constexpr Part kTwist{"geometry_msgs/Twist", R"(geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
)"};

constexpr Part kNavSatStatus{"sensor_msgs/NavSatStatus", R"(int8 STATUS_NO_FIX=-1
int8 STATUS_FIX=0
int8 STATUS_SBAS_FIX=1
int8 STATUS_GBAS_FIX=2
uint16 SERVICE_GPS=1
uint16 SERVICE_GLONASS=2
uint16 SERVICE_COMPASS=4
uint16 SERVICE_GALILEO=8
int8 status
uint16 service
)"};

/// As a bag holds it: what follows a line of its own is told apart by a line of 80 signs.
std::string with_parts(std::string_view fields, std::initializer_list<Part> parts) {
  std::string text(fields);
  for (const Part& part : parts) {
    text += "\n" + std::string(80, '=') + "\nMSG: ";
    text += part.type;
    text += "\n";
    text += part.fields;
  }
  return text;
}

}  // namespace

std::string point_cloud2_definition() {
  return with_parts(R"(std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
)",
                    {kHeader, kPointField});
}

std::string imu_definition() {
  return with_parts(R"(std_msgs/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
)",
                    {kHeader, kQuaternion, kVector3});
}

std::string odometry_definition() {
  return with_parts(R"(std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
)",
                    {kHeader, kPoseWithCovariance, kPose, kPoint, kQuaternion, kTwistWithCovariance,
                     kTwist, kVector3});
}

std::string nav_sat_fix_definition() {
  return with_parts(R"(uint8 COVARIANCE_TYPE_UNKNOWN=0
uint8 COVARIANCE_TYPE_APPROXIMATED=1
uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2
uint8 COVARIANCE_TYPE_KNOWN=3
std_msgs/Header header
sensor_msgs/NavSatStatus status
float64 latitude
float64 longitude
float64 altitude
float64[9] position_covariance
uint8 position_covariance_type
)",
                    {kHeader, kNavSatStatus});
}

}  // namespace holdfast::io::ros
