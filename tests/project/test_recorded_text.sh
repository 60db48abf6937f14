#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What the programs print and write without OpenGL: help, messages, tables, hair files, reports, compared with a record.
. tests/support/recorded.sh
recorded_check text
