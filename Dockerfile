# ldso in a container: the packages are made and installed by the same scripts as elsewhere (scripts/package.sh).
#
#   docker build -t ldso .
#   docker run --rm -v "$PWD:/data" ldso run /data/video.mp4 --calib /data/camera.txt -o /data/out
FROM debian:12 AS build
COPY . /src
RUN apt-get update && /src/scripts/package.sh

FROM debian:12
COPY --from=build /src/out/packages /packages
RUN apt-get update \
  && apt-get install -y --no-install-recommends /packages/ldso_*.deb /packages/python3-ldso_*.deb \
  && rm -rf /var/lib/apt/lists/* /packages
ENTRYPOINT ["ldso"]
