# Debian's rosbag headers pull in headers of ROS 2 packages that nest one folder deeper than they
# are included; this file is the only place that knows.
find_package(Boost REQUIRED COMPONENTS filesystem)
find_library(ROSBAG_STORAGE_LIBRARY rosbag_storage REQUIRED)
find_library(ROSTIME_LIBRARY rostime REQUIRED)
find_library(CPP_COMMON_LIBRARY cpp_common REQUIRED)
find_library(ROSCPP_SERIALIZATION_LIBRARY roscpp_serialization REQUIRED)

add_library(holdfast_rosbag INTERFACE)
foreach(package pluginlib class_loader rcpputils rcutils ament_index_cpp)
  target_include_directories(holdfast_rosbag SYSTEM INTERFACE /usr/include/${package})
endforeach()
target_link_libraries(holdfast_rosbag INTERFACE
  ${ROSBAG_STORAGE_LIBRARY} ${ROSTIME_LIBRARY} ${CPP_COMMON_LIBRARY}
  ${ROSCPP_SERIALIZATION_LIBRARY} Boost::filesystem)
