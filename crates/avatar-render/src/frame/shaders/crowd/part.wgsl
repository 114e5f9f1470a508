@vertex
fn crowd_main(in: CrowdIn) -> VertexOut {
    return vertex_out(of_one(in));
}
