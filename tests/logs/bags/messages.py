# SPDX-FileCopyrightText: 2026 The trussmap authors
# SPDX-License-Identifier: MIT
"""Standard ROS 2 messages: their definitions as bags keep them, and dicts for the usual ones.

    definition("nav_msgs/msg/Odometry")   text with that of all types within
    odometry(stamp_ns, x=1.0, y=2.0, heading=0.5, speed=0.3, turn=0.1)
"""

import math
import re

BODIES = {
    "builtin_interfaces/Time": "# since the epoch\nint32 sec\n\nuint32 nanosec\n",
    "std_msgs/Header": "builtin_interfaces/Time stamp\n\n# of the transform\nstring frame_id\n",
    "std_msgs/String": "string data\n",
    "std_msgs/Float64": "float64 data\n",
    "std_msgs/Empty": "",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/Quaternion": "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n",
    "geometry_msgs/Pose": "Point position\nQuaternion orientation\n",
    "geometry_msgs/PoseStamped": "std_msgs/Header header\nPose pose\n",
    "geometry_msgs/PoseWithCovariance": "Pose pose\n# row by row\nfloat64[36] covariance\n",
    "geometry_msgs/Twist": "Vector3  linear\nVector3  angular\n",
    "geometry_msgs/TwistStamped": "std_msgs/Header header\nTwist twist\n",
    "geometry_msgs/TwistWithCovariance": "Twist twist\nfloat64[36] covariance\n",
    "geometry_msgs/Transform": "Vector3 translation\nQuaternion rotation\n",
    "geometry_msgs/TransformStamped":
        "std_msgs/Header header\nstring child_frame_id # of the other\nTransform transform\n",
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms\n",
    "nav_msgs/Odometry":
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
        "geometry_msgs/TwistWithCovariance twist\n",
    "sensor_msgs/JointState":
        "std_msgs/Header header\n\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
        "float64[] effort\n",
    "sensor_msgs/Imu":
        "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
        "float64[9] orientation_covariance # Row major about x, y, z axes\n"
        "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
        "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
    "sensor_msgs/NavSatStatus":
        "int8 STATUS_NO_FIX =  -1        # unable to fix\nint8 STATUS_FIX = 0\nint8 status\n"
        "uint16 SERVICE_GPS = 1\nuint16 service\n",
    "sensor_msgs/NavSatFix":
        "std_msgs/Header header\nNavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
        "float64 altitude\nfloat64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN = 0\n"
        "uint8 position_covariance_type\n",
    "sensor_msgs/Range":
        "std_msgs/Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\n"
        "float32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\n",
    "sensor_msgs/Image":
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
        "uint8 is_bigendian\nuint32 step\nuint8[] data\n",
    "sensor_msgs/PointField":
        "uint8 FLOAT32 = 7\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n",
    "sensor_msgs/PointCloud2":
        "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\n"
        "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
    "apriltag_msgs/Point": "float64 x\nfloat64 y\n",
    "apriltag_msgs/AprilTagDetection":
        "string family\nint32 id\nint32 hamming\nfloat32 goodness\nfloat32 decision_margin\n"
        "Point centre\nPoint[4] corners\nfloat64[9] homography\n",
    "apriltag_msgs/AprilTagDetectionArray":
        "std_msgs/Header header\nAprilTagDetection[] detections\n",
    "ros2_aruco_interfaces/ArucoMarkers":
        "std_msgs/Header header\nint64[] marker_ids\ngeometry_msgs/Pose[] poses\n",
}  # fmt: skip


def definition(kind):
    """The text of a type, then, each once, of those within it."""
    name = kind.replace("/msg/", "/")
    names = [name]
    for one in names:
        for base in re.findall(r"^([A-Za-z_0-9/]+)", BODIES[one], flags=re.MULTILINE):
            inner = base if "/" in base else f"{one.split('/')[0]}/{base}"
            if inner in BODIES and inner not in names:
                names.append(inner)
    parts = [BODIES[name]]
    parts += ["=" * 80 + f"\nMSG: {one}\n" + BODIES[one] for one in names[1:]]
    return "\n".join(parts)


def stamp(time_ns):
    return {"sec": time_ns // 10**9, "nanosec": time_ns % 10**9}


def header(time_ns, frame_id=""):
    return {"stamp": stamp(time_ns), "frame_id": frame_id}


def turned(heading):
    return {"z": math.sin(heading / 2), "w": math.cos(heading / 2)}


def pose(x, y, heading):
    return {"position": {"x": x, "y": y}, "orientation": turned(heading)}


def odometry(time_ns, x, y, heading, speed=0.0, turn=0.0, frame="odom", child="base_link"):
    """nav_msgs/msg/Odometry"""
    return {
        "header": header(time_ns, frame),
        "child_frame_id": child,
        "pose": {"pose": pose(x, y, heading)},
        "twist": {"twist": {"linear": {"x": speed}, "angular": {"z": turn}}},
    }


def joint_state(time_ns, names, positions, velocities=(), efforts=()):
    """sensor_msgs/msg/JointState"""
    return {
        "header": header(time_ns),
        "name": list(names),
        "position": list(positions),
        "velocity": list(velocities),
        "effort": list(efforts),
    }


def imu(time_ns, turn, acceleration=(0.0, 0.0, 9.81), heading=0.0, frame="imu"):
    """sensor_msgs/msg/Imu; `turn` about z."""
    x, y, z = acceleration
    return {
        "header": header(time_ns, frame),
        "orientation": turned(heading),
        "angular_velocity": {"z": turn},
        "linear_acceleration": {"x": x, "y": y, "z": z},
    }


def transform(time_ns, parent, child, x, y, heading):
    """geometry_msgs/msg/TransformStamped"""
    return {
        "header": header(time_ns, parent),
        "child_frame_id": child,
        "transform": {"translation": {"x": x, "y": y}, "rotation": turned(heading)},
    }


def tf(*transforms):
    """tf2_msgs/msg/TFMessage"""
    return {"transforms": list(transforms)}


def pose_stamped(time_ns, x, y, heading, frame="map"):
    """geometry_msgs/msg/PoseStamped"""
    return {"header": header(time_ns, frame), "pose": pose(x, y, heading)}


def nav_sat_fix(time_ns, latitude, longitude, altitude=0.0, variance=1.0, status=0):
    """sensor_msgs/msg/NavSatFix; degrees, m, m^2."""
    return {
        "header": header(time_ns, "gps"),
        "status": {"status": status, "service": 1},
        "latitude": latitude,
        "longitude": longitude,
        "altitude": altitude,
        "position_covariance": [variance, 0.0, 0.0, 0.0, variance, 0.0, 0.0, 0.0, variance],
        "position_covariance_type": 2,
    }


def string(value):
    """std_msgs/msg/String"""
    return {"data": value}


def range_(time_ns, distance, frame="sonar"):
    """sensor_msgs/msg/Range"""
    return {"header": header(time_ns, frame), "min_range": 0.1, "max_range": 10.0, "range": distance}
