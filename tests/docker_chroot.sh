#!/usr/bin/env bash
# Runs the steps of docker/Dockerfile one by one in chroots made by debootstrap, without a container
# engine, then serves from the last one as compose.yaml does and renders a picture. `newcomer` runs
# ./run.sh --once in a clean clone instead, where nothing is installed but git.
#   tests/docker_chroot.sh [dockerfile | newcomer]
# Needs root, the network, and Debian's debootstrap, iproute2 and curl. Knows the instructions that
# the Dockerfile has, in the forms it has them. WRAP: a command that each step is run through.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=${WORK:-/var/tmp/translucube-chroot}
base=$work/base
sources=/etc/apt/sources.list.d/debian.sources

make_base() { # what debian:12-slim is, about
  [ -e "$base.done" ] && return
  rm -rf "$base"
  debootstrap --variant=minbase bookworm "$base" "$(sed -n 's/^URIs: //p' $sources | head -n 1)"
  cp $sources "$base/etc/apt/sources.list.d/"
  rm "$base/etc/apt/sources.list"
  touch "$base.done"
}

new_root() { # name
  root=$work/$1
  ! mountpoint -q "$root/proc" || umount "$root/proc"
  rm -rf "$root"
  cp -a "$base" "$root"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
}

inside() { # user, folder, command
  mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
  ${WRAP:-} chroot --userspec="$1" "$root" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    sh -c "cd '$2' && $3"
}

copy() { # from this folder, its files, to the last of the arguments
  local from=$1 to=${*: -1} file
  shift
  [ "$to" != . ] || to=$folder/
  [[ $to == /* ]] || to=$folder/$to
  if [[ $to == */ ]]; then mkdir -p "$root/$to"; else mkdir -p "$root/$(dirname "$to")"; fi
  while [ $# -gt 1 ]; do
    file=$from/$1
    if [ -d "$file" ]; then mkdir -p "$root/$to" && cp -a "$file/." "$root/$to/"; else cp -a "$file" "$root/$to"; fi
    shift
  done
}

words() { tr -d '[],"' <<<"$1"; }  # of a JSON array of words

dockerfile() {
  local context=$work/context instruction rest entry= command= health=
  rm -rf "$context" && mkdir -p "$context"
  git -C "$repository" archive HEAD | tar -x -C "$context"
  while read -r ignored; do rm -rf "${context:?}/$ignored"; done <"$repository/.dockerignore"
  while read -r instruction rest; do
    echo "== $instruction $rest"
    case $instruction in
      FROM)
        read -r image _ stage <<<"$rest"
        [ "$image" = debian:12-slim ]
        new_root "stage-${stage:-last}"
        folder=/ user=root
        ;;
      WORKDIR) folder=$rest && mkdir -p "$root/$folder" ;;
      COPY)
        local from=$context
        if [[ $rest == --from=* ]]; then
          from=${rest%% *} rest=${rest#* }
          from=$work/stage-${from#--from=}
        fi
        # shellcheck disable=SC2086
        copy "$from" $rest
        ;;
      RUN) inside "$user" "$folder" "$rest" ;;
      USER) user=$rest ;;
      VOLUME) [ -d "$root/$rest" ] ;;
      EXPOSE) port=$rest ;;
      HEALTHCHECK) health=$(words "${rest#*CMD }") ;;
      ENTRYPOINT) entry=$(words "$rest") ;;
      CMD) command=$(words "$rest") ;;
      *) echo "unknown instruction" >&2 && exit 1 ;;
    esac
  done < <(sed -e '/^#/d' "$repository/docker/Dockerfile" | sed -e ':more' -e '/\\$/{N;s/\\\n *//;b more' -e '}' | sed '/^$/d')
  umount "$root/proc"
  # Only loopback, and only its own processes.
  ROOT=$root OWNER=$user PORT=$port HEALTH=$health SERVE="$entry $command" ENTRY=$entry \
    unshare --mount --net --pid --fork --kill-child bash "$repository/tests/docker_chroot.sh" serve
}

serve() { # as docker/compose.yaml: read-only but for /data and /tmp
  mount -t proc proc /proc  # of this namespace's processes
  ip link set lo up
  local token picture=$work/picture.png pid
  mount --bind "$ROOT" "$ROOT"
  mkdir -p "$ROOT/run/secrets"
  local container=(chroot --userspec="$OWNER" "$ROOT" env -i PATH=/usr/local/bin:/usr/bin:/bin)
  mount -t proc proc "$ROOT/proc"
  # shellcheck disable=SC2086
  "${container[@]}" $ENTRY token --name test >"$work/token"
  token=$(sed -n "s/^token[^:]*: *//p" "$work/token")
  echo "{\"tokens\": [$(grep -o '{.*}' "$work/token")]}" >"$ROOT/run/secrets/tokens.json"
  mount --bind "$ROOT/data" "$ROOT/data"
  mount -o remount,ro,bind "$ROOT"
  mount -t tmpfs tmpfs "$ROOT/tmp"
  # shellcheck disable=SC2086
  "${container[@]}" $SERVE &
  pid=$!
  for _ in $(seq 100); do
    # shellcheck disable=SC2086
    "${container[@]}" $HEALTH 2>/dev/null && break
    sleep 0.1
  done
  # shellcheck disable=SC2086
  "${container[@]}" $HEALTH
  echo "user: $(sed -n 's/^Uid:\t\([0-9]*\).*/\1/p' /proc/$pid/status)"
  [ "$(sed -n 's/^Uid:\t\([0-9]*\).*/\1/p' /proc/$pid/status)" = 10001 ]
  local service=http://127.0.0.1:$PORT id
  [ "$(curl -s -o /dev/null -w '%{http_code}' "$service/v1/renders")" = 401 ]
  id=$(curl -fsS -H "Authorization: Bearer $token" -H 'Prefer: wait=60' "$service/v1/renders" --json \
    '{"material": {"cube": {"absorption": 0.3, "roughness": 0.3, "scattering": 0.5}}, "quality": {"samples": 8}}' |
    grep -o '"id": *"[0-9A-Z]*"' | head -n 1 | grep -o '[0-9A-Z]\{26\}')
  curl -fsS -H "Authorization: Bearer $token" "$service/v1/renders/$id/image?format=png" -o "$picture"
  [ "$(head -c 4 "$picture" | tail -c 3)" = PNG ]
  kill -TERM $pid
  wait $pid
  echo "a picture came from the container's steps: $picture, $(stat -c %s "$picture") bytes"
}

newcomer() {
  new_root newcomer
  inside root / "apt-get update -q && apt-get install -q -y --no-install-recommends git ca-certificates"
  git clone -q --no-local "$repository" "$root/root/translucube"
  inside root /root/translucube "./run.sh --once"
  cp "$root/root/translucube/out/translucube.png" "$work/newcomer.png"
  umount "$root/proc"
  echo "a newcomer's picture: $work/newcomer.png"
}

case ${1:-dockerfile} in
  dockerfile) mkdir -p "$work" && make_base && dockerfile ;;
  newcomer) mkdir -p "$work" && make_base && newcomer ;;
  serve) serve ;;
  *) sed -n '2,8p' "$0" >&2 && exit 2 ;;
esac
