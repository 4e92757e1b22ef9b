#!/usr/bin/env bash
# Builds Translucube, starts its service, and renders a translucent sphere in the forest over HTTP.
set -euo pipefail
cd "$(dirname "$0")"

usage() {
  cat <<'TEXT'
./run.sh [--once] [--port N]
  installs what is missing (Debian 12, apt-get), builds, starts the service and renders one picture
  to out/translucube.png. The service stays up; --once stops it after the picture.
TEXT
}

once=false
port=8080
while [ $# -gt 0 ]; do
  case $1 in
    --once) once=true ;;
    --port) port=${2:?--port needs a number}; shift ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

began=$SECONDS
bash .ci/install_packages.sh
installed=$SECONDS

cmake --preset release >/dev/null
cmake --build --preset release --target translucube
built=$SECONDS

if (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; then
  echo "port $port is taken: using a free one"
  port=0
fi

mkdir -p out
log=out/service.log
serve=(build/release/bin/translucube serve --port "$port")
if $once; then
  # Apart from the queue and the log of a service that may be running.
  log=out/once.log
  data=$(mktemp -d)
  serve+=(--data "$data")
fi
nohup setsid "${serve[@]}" >"$log" 2>&1 </dev/null &
pid=$!

stop() {
  kill "$pid" 2>/dev/null || true
  wait "$pid" 2>/dev/null || true
  [ -z "${data:-}" ] || rm -rf "$data"
}
trap stop EXIT

fail() {
  echo "$1" >&2
  tail -n 20 "$log" >&2
  exit 1
}

address=""
for _ in $(seq 300); do
  address=$(sed -n 's/^listening on \(http:.*\)$/\1/p' "$log")
  [ -n "$address" ] && curl -fsS -o /dev/null "$address/readyz" 2>/dev/null && break
  kill -0 "$pid" 2>/dev/null || fail "the service ended before it was ready:"
  sleep 0.1
done
[ -n "$address" ] || fail "the service was not ready within 30 s:"
ready=$SECONDS
echo "service ready at $address"

request='{
  "material": {"cube": {"absorption": 0.35, "roughness": 0, "scattering": 0.35}, "absorber": "red-glass"},
  "scene": {"environment": {"image": "forest"}},
  "image": {"width": 512, "height": 512},
  "quality": {"seconds": 20}
}'
answer=$(curl --fail-with-body -sS -X POST "$address/v1/renders" -H 'Content-Type: application/json' \
  -H 'Prefer: wait=60' --data "$request") || fail "the render was refused: $answer"
field() { sed -n "s/.*\"$1\": *\"\([^\"]*\)\".*/\1/p" <<<"$answer" | head -n 1; }
# One value a line, so that `field` meets one of a name at a time.
answer=${answer//,/$'\n'}
id=$(field id)
[ -n "$id" ] || fail "the answer names no render:"
while state=$(field state) && [ "$state" != succeeded ]; do
  case $state in
    queued | running) sleep 0.5 ;;
    *) fail "the render ended as '$state': $answer" ;;
  esac
  answer=$(curl -fsS "$address/v1/renders/$id") || fail "the service does not answer:"
  answer=${answer//,/$'\n'}
done
curl -fsS "$address/v1/renders/$id/image?format=png" -o out/translucube.png || fail "no image:"
rendered=$SECONDS

cat <<TEXT

picture:  $PWD/out/translucube.png
took:     $((rendered - began)) s (packages $((installed - began)), build $((built - installed)), start $((ready - built)), render $((rendered - ready)))
TEXT
if ! $once; then
  trap - EXIT
  cat <<TEXT
service:  $address (process $pid, log $PWD/$log)
to stop:  kill $pid
TEXT
fi
