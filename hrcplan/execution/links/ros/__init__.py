"""ROS 2: action servers, performers of PlanSys2, and topics, without a line of ROS in hrcplan.

``bridge.py`` and ``robot.py`` run on the Python of ROS and import nothing of hrcplan. The mapping
file of a user (``mapping.py``) says which action server carries out which action of the domain;
``filling.py`` makes goals and facts of it. `RosLink` (``link.py``) is the robot link.
"""
