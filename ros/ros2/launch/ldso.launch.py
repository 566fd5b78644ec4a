"""ros2 launch ldso_ros ldso.launch.py image:=/camera/image_raw [transport:=compressed] [results:=/tmp/out]"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    arguments = {"image": "/camera/image_raw", "transport": "raw", "calibration": "", "results": ""}
    return LaunchDescription(
        [DeclareLaunchArgument(name, default_value=value) for name, value in arguments.items()] + [
            Node(package="ldso_ros", executable="slam_node", name="ldso", output="screen", parameters=[{
                "image_topic": LaunchConfiguration("image"),
                "image_transport": LaunchConfiguration("transport"),
                "calibration": LaunchConfiguration("calibration"),
                "results": LaunchConfiguration("results"),
            }]),
        ])
