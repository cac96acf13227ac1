# ROS 2 Jazzy on Ubuntu 24.04 with this workspace built in it, for example:
#   docker build --tag wrist_control .
#   docker run --rm wrist_control python3 examples/teleoperate.py
FROM ros:jazzy-ros-base-noble
SHELL ["/bin/bash", "-o", "pipefail", "-c"]

# Before everything else, so that an edit of the code does not install them again.
COPY scripts/apt_packages.py scripts/machine.py /tmp/
RUN apt-get update \
  && python3 /tmp/apt_packages.py | xargs apt-get install --yes --no-install-recommends \
  && rm -rf /var/lib/apt/lists/*

USER ubuntu
RUN mkdir /home/ubuntu/wrist_control
WORKDIR /home/ubuntu/wrist_control
COPY --chown=ubuntu:ubuntu . .
RUN . /opt/ros/jazzy/setup.sh && make setup

# The first one sources ROS, the second puts this workspace around what is run.
ENTRYPOINT ["/ros_entrypoint.sh", "/home/ubuntu/wrist_control/env"]
CMD ["bash"]
