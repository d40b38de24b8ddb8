// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/ros2_standard.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace trussmap::logs {
namespace {

using Definition = std::pair<std::string_view, std::string_view>;

// In order of their names.
constexpr auto kDefinitions = std::to_array<Definition>({
    {"apriltag_msgs/AprilTagDetection",
     "string family\nint32 id\nint32 hamming\nfloat32 goodness\nfloat32 decision_margin\nPoint "
     "centre\nPoint[4] corners\nfloat64[9] homography"},
    {"apriltag_msgs/AprilTagDetectionArray",
     "std_msgs/Header header\nAprilTagDetection[] detections"},
    {"apriltag_msgs/Point", "float64 x\nfloat64 y"},
    {"aruco_msgs/Marker",
     "std_msgs/Header header\nuint32 id\ngeometry_msgs/PoseWithCovariance pose\nfloat64 "
     "confidence"},
    {"aruco_msgs/MarkerArray", "std_msgs/Header header\naruco_msgs/Marker[] markers"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"},
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec"},
    {"diagnostic_msgs/DiagnosticArray", "std_msgs/Header header\nDiagnosticStatus[] status"},
    {"diagnostic_msgs/DiagnosticStatus",
     "byte level\nstring name\nstring message\nstring hardware_id\nKeyValue[] values"},
    {"diagnostic_msgs/KeyValue", "string key\nstring value"},
    {"geometry_msgs/Accel", "Vector3 linear\nVector3 angular"},
    {"geometry_msgs/AccelStamped", "std_msgs/Header header\nAccel accel"},
    {"geometry_msgs/AccelWithCovariance", "Accel accel\nfloat64[36] covariance"},
    {"geometry_msgs/AccelWithCovarianceStamped",
     "std_msgs/Header header\nAccelWithCovariance accel"},
    {"geometry_msgs/Inertia",
     "float64 m\ngeometry_msgs/Vector3 com\nfloat64 ixx\nfloat64 ixy\nfloat64 ixz\nfloat64 "
     "iyy\nfloat64 iyz\nfloat64 izz"},
    {"geometry_msgs/InertiaStamped", "std_msgs/Header header\nInertia inertia"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
    {"geometry_msgs/Point32", "float32 x\nfloat32 y\nfloat32 z"},
    {"geometry_msgs/PointStamped", "std_msgs/Header header\nPoint point"},
    {"geometry_msgs/Polygon", "Point32[] points"},
    {"geometry_msgs/PolygonStamped", "std_msgs/Header header\nPolygon polygon"},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation"},
    {"geometry_msgs/Pose2D", "float64 x\nfloat64 y\nfloat64 theta"},
    {"geometry_msgs/PoseArray", "std_msgs/Header header\nPose[] poses"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose"},
    {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance"},
    {"geometry_msgs/PoseWithCovarianceStamped", "std_msgs/Header header\nPoseWithCovariance pose"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
    {"geometry_msgs/QuaternionStamped", "std_msgs/Header header\nQuaternion quaternion"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\nTransform transform"},
    {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular"},
    {"geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist"},
    {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance"},
    {"geometry_msgs/TwistWithCovarianceStamped",
     "std_msgs/Header header\nTwistWithCovariance twist"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
    {"geometry_msgs/Vector3Stamped", "std_msgs/Header header\nVector3 vector"},
    {"geometry_msgs/VelocityStamped",
     "std_msgs/Header header\nstring body_frame_id\nstring reference_frame_id\nTwist velocity"},
    {"geometry_msgs/Wrench", "Vector3 force\nVector3 torque"},
    {"geometry_msgs/WrenchStamped", "std_msgs/Header header\nWrench wrench"},
    {"nav_msgs/GridCells",
     "std_msgs/Header header\nfloat32 cell_width\nfloat32 cell_height\ngeometry_msgs/Point[] "
     "cells"},
    {"nav_msgs/MapMetaData",
     "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 "
     "height\ngeometry_msgs/Pose origin"},
    {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nMapMetaData info\nint8[] data"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance "
     "pose\ngeometry_msgs/TwistWithCovariance twist"},
    {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses"},
    {"ros2_aruco_interfaces/ArucoMarkers",
     "std_msgs/Header header\nint64[] marker_ids\ngeometry_msgs/Pose[] poses"},
    {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock"},
    {"sensor_msgs/BatteryState",
     "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\nfloat32 "
     "charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\nuint8 "
     "power_supply_status\nuint8 power_supply_health\nuint8 power_supply_technology\nbool "
     "present\nfloat32[] cell_voltage\nfloat32[] cell_temperature\nstring location\nstring "
     "serial_number"},
    {"sensor_msgs/CameraInfo",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] "
     "d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 "
     "binning_y\nRegionOfInterest roi"},
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data"},
    {"sensor_msgs/FluidPressure",
     "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance"},
    {"sensor_msgs/Illuminance", "std_msgs/Header header\nfloat64 illuminance\nfloat64 variance"},
    {"sensor_msgs/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 "
     "is_bigendian\nuint32 step\nuint8[] data"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] "
     "orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\nfloat64[9] "
     "angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\nfloat64[9] "
     "linear_acceleration_covariance"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] "
     "effort"},
    {"sensor_msgs/Joy", "std_msgs/Header header\nfloat32[] axes\nint32[] buttons"},
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 "
     "angle_increment\nfloat32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 "
     "range_max\nfloat32[] ranges\nfloat32[] intensities"},
    {"sensor_msgs/MagneticField",
     "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\nfloat64[9] "
     "magnetic_field_covariance"},
    {"sensor_msgs/MultiDOFJointState",
     "std_msgs/Header header\nstring[] joint_names\ngeometry_msgs/Transform[] "
     "transforms\ngeometry_msgs/Twist[] twist\ngeometry_msgs/Wrench[] wrench"},
    {"sensor_msgs/NavSatFix",
     "std_msgs/Header header\nNavSatStatus status\nfloat64 latitude\nfloat64 longitude\nfloat64 "
     "altitude\nfloat64[9] position_covariance\nuint8 position_covariance_type"},
    {"sensor_msgs/NavSatStatus", "int8 status\nuint16 service"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool "
     "is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense"},
    {"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count"},
    {"sensor_msgs/Range",
     "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 "
     "min_range\nfloat32 max_range\nfloat32 range"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify"},
    {"sensor_msgs/RelativeHumidity",
     "std_msgs/Header header\nfloat64 relative_humidity\nfloat64 variance"},
    {"sensor_msgs/Temperature", "std_msgs/Header header\nfloat64 temperature\nfloat64 variance"},
    {"sensor_msgs/TimeReference",
     "std_msgs/Header header\nbuiltin_interfaces/Time time_ref\nstring source"},
    {"std_msgs/Bool", "bool data"},
    {"std_msgs/Byte", "byte data"},
    {"std_msgs/ByteMultiArray", "MultiArrayLayout layout\nbyte[] data"},
    {"std_msgs/Char", "char data"},
    {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a"},
    {"std_msgs/Empty", ""},
    {"std_msgs/Float32", "float32 data"},
    {"std_msgs/Float32MultiArray", "MultiArrayLayout layout\nfloat32[] data"},
    {"std_msgs/Float64", "float64 data"},
    {"std_msgs/Float64MultiArray", "MultiArrayLayout layout\nfloat64[] data"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id"},
    {"std_msgs/Int16", "int16 data"},
    {"std_msgs/Int16MultiArray", "MultiArrayLayout layout\nint16[] data"},
    {"std_msgs/Int32", "int32 data"},
    {"std_msgs/Int32MultiArray", "MultiArrayLayout layout\nint32[] data"},
    {"std_msgs/Int64", "int64 data"},
    {"std_msgs/Int64MultiArray", "MultiArrayLayout layout\nint64[] data"},
    {"std_msgs/Int8", "int8 data"},
    {"std_msgs/Int8MultiArray", "MultiArrayLayout layout\nint8[] data"},
    {"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride"},
    {"std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset"},
    {"std_msgs/String", "string data"},
    {"std_msgs/UInt16", "uint16 data"},
    {"std_msgs/UInt16MultiArray", "MultiArrayLayout layout\nuint16[] data"},
    {"std_msgs/UInt32", "uint32 data"},
    {"std_msgs/UInt32MultiArray", "MultiArrayLayout layout\nuint32[] data"},
    {"std_msgs/UInt64", "uint64 data"},
    {"std_msgs/UInt64MultiArray", "MultiArrayLayout layout\nuint64[] data"},
    {"std_msgs/UInt8", "uint8 data"},
    {"std_msgs/UInt8MultiArray", "MultiArrayLayout layout\nuint8[] data"},
    {"tf2_msgs/TF2Error", "uint8 error\nstring error_string"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms"},
});

}  // namespace

std::string_view standard_ros2_definition(std::string_view type) {
  const auto found = std::lower_bound(
      kDefinitions.begin(), kDefinitions.end(), type,
      [](const Definition& one, std::string_view name) { return one.first < name; });
  return found != kDefinitions.end() && found->first == type ? found->second : std::string_view();
}

}  // namespace trussmap::logs
