#!/usr/bin/env bash
# Every plugin that gamut finds passes the checks of its kind. Prints TAP, one subtest a plugin.
exec "$GAMUT" --no-user-plugins verify --all
