#!/usr/bin/env bash
# run_tests.sh PYTHON PROGRAM MODULE-FOLDER SEQUENCE: the tests of the Python module by pytest.
set -euo pipefail
python=$1 program=$2 module=$3 sequence=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for package in pytest numpy; do
  if ! "$python" -c "import $package" 2>/dev/null; then
    echo "skipped: python3-$package is not installed (scripts/install_packages.sh python)"
    exit 77
  fi
done
export PYTHONPATH=$module PYTHONDONTWRITEBYTECODE=1 LDSO_PROGRAM=$program LDSO_SEQUENCE=$sequence
exec "$python" -m pytest -q -p no:cacheprovider "$here"
