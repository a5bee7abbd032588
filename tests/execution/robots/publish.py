"""Publishes messages that come as lines of JSON on standard input; runs on the Python of ROS."""

import json
import sys
from importlib import import_module
from typing import Any

import rclpy

rclpy.init(args=[])
node = rclpy.create_node("publisher")
publishers: dict[str, Any] = {}
for line in sys.stdin:
    order = json.loads(line)
    package, kind, name = order["type"].split("/")
    message_type = getattr(import_module(f"{package}.{kind}"), name)
    if order["topic"] not in publishers:
        publishers[order["topic"]] = node.create_publisher(message_type, order["topic"], 10)
    publisher = publishers[order["topic"]]
    while not publisher.get_subscription_count():
        rclpy.spin_once(node, timeout_sec=0.02)
    message = message_type()
    for path, value in order["fields"].items():
        place = message
        *way, last = path.split(".")
        for step in way:
            place = getattr(place, step)
        setattr(place, last, value)
    publisher.publish(message)
    sys.stdout.write("sent\n")
    sys.stdout.flush()
