# Sourced by the programs of this folder: tells what they do, by the comment that they begin with, where --help asks for it.
if [[ ${1:-} == -h || ${1:-} == --help ]]; then
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"
  exit
fi
