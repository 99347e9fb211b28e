#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs a command in the folder of this file: beamrate runs programs in an empty one.
cd "$(dirname "$0")" && exec "$@"
