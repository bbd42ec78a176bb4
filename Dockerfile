# articad in a container, for macOS, Windows, and for files and models that you do not trust.
#
#   docker build -t articad .
#   docker run --rm --network none --cap-drop ALL --security-opt no-new-privileges --read-only --tmpfs /tmp:rw,size=4g \
#     --memory 8g --pids-limit 512 --user "$(id -u):$(id -g)" -v "$PWD:/work" articad audit robot.urdf
#
# Leave out `--network none` only for commands that call a model, and hand over the one key that they need: -e OPENAI_API_KEY.
# Part scripts run under Landlock and seccomp in here, which is a sufficient level; `articad doctor` says what was reached.
FROM python:3.12-slim-bookworm

RUN apt-get update \
 && apt-get install --yes --no-install-recommends libgl1 libgomp1 libglib2.0-0 bubblewrap \
 && rm -rf /var/lib/apt/lists/*

# Everything that is installed stands in the lock with its hash.
COPY requirements.lock /tmp/requirements.lock
RUN pip install --no-cache-dir --require-hashes --only-binary :all: -r /tmp/requirements.lock && rm /tmp/requirements.lock
COPY pyproject.toml README.md LICENSE /src/
COPY articad /src/articad
COPY examples /src/examples
RUN pip install --no-cache-dir --no-deps --no-build-isolation /src && rm -rf /src

RUN useradd --create-home --uid 1000 articad && mkdir /work && chown articad /work
USER articad
ENV HOME=/tmp ARTICAD_CACHE=/tmp/articad-cache PYTHONDONTWRITEBYTECODE=1
WORKDIR /work
ENTRYPOINT ["articad"]
CMD ["doctor"]
