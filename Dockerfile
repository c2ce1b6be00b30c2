# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# docker build -t cartographer_sdf --build-arg COMMIT="$(git describe --always --dirty)" .
# docker run --rm -v "$PWD:/maps" cartographer_sdf close_loops map.pbstream -o closed.pbstream
#
# scripts/test_packages.sh --build does the steps of both stages without Docker.

FROM debian:12 AS build
ARG COMMIT=unknown
COPY . /source
RUN CMAKE_OPTIONS="-DCARTOGRAPHER_SDF_COMMIT=${COMMIT}" \
    BUILD_DIR=/build /source/scripts/make_packages.sh /packages

FROM debian:12-slim
COPY --from=build /packages/cartographer-sdf_*.deb /packages/python3-cartographer-sdf_*.deb /packages/
RUN apt-get update \
    && apt-get install -y --no-install-recommends /packages/*.deb \
    && rm -rf /packages /var/lib/apt/lists/*
WORKDIR /maps
ENTRYPOINT ["cartographer_sdf"]
CMD ["help"]
