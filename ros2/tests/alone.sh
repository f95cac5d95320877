#!/bin/sh
# Runs a command in a network of its own: a loopback with multicast, and nothing else.
set -e
ip link set lo up
ip link set lo multicast on
ip route add 224.0.0.0/4 dev lo
export CYCLONEDDS_URI='<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces></General></Domain></CycloneDDS>'
exec "$@"
