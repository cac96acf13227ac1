# The ROS 2 wheels export message targets whose Python headers lie in /opt/python, a directory of
# the machine that built the wheels.  Point those targets at the Python used here; in an ordinary
# ROS 2 installation no target matches and nothing happens.
get_property(_targets DIRECTORY PROPERTY IMPORTED_TARGETS)
foreach(_target IN LISTS _targets)
  get_target_property(_directories ${_target} INTERFACE_INCLUDE_DIRECTORIES)
  if(_directories MATCHES "^/opt/python/")
    set_property(TARGET ${_target} PROPERTY INTERFACE_INCLUDE_DIRECTORIES
      ${Python3_INCLUDE_DIRS} ${Python3_NumPy_INCLUDE_DIRS})
  endif()
endforeach()
